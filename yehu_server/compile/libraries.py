"""What numba's functions are compiled into: code that can be made again for another level.

Most of the time that compiling takes is numba's own, to find types and to write LLVM's code, which
is the same for all levels. So each function keeps that code, as it was before LLVM optimised it.
Machine code is made only of functions that are called by address: of those that become parts of
others it would be a tenth of the time.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Self

from llvmlite import binding
from numba.core.codegen import JITCodeLibrary
from numba.core.itanium_mangler import PREFIX as ITANIUM


class SourceLibrary(JITCodeLibrary):  # type: ignore[misc]
    """A function that knows what it was made of."""

    kind = "source"  # numba has words for others

    def __init__(self, codegen: Any, name: str) -> None:
        super().__init__(codegen, name)
        self.file = ""  # where what it was made of is kept, if it is
        self._modules: list[bytes] = []
        self._made_of: tuple[str, str, Any] | None = None  # where it was made of what was kept
        self.enable_object_caching()

    def add_llvm_module(self, ll_module: Any) -> None:
        """Keep and take in code of its own, with numba's name for this."""
        self._modules.append(ll_module.as_bitcode())
        super().add_llvm_module(ll_module)

    def source(self) -> tuple[str, str, Any] | None:
        """What the cache keeps for all levels: its own modules, and what it links.

        That is files of other functions, and modules of numba's own. None where one is not kept.
        """
        if self._made_of is not None:
            return self._made_of
        links: list[str | bytes] = []
        for other in dict.fromkeys(self._linking_libraries):
            if not isinstance(other, SourceLibrary):
                links.append(other._get_module_for_linking().as_bitcode())  # noqa: SLF001
            elif other.file:
                links.append(other.file)
            else:
                return None
        return self.name, self.kind, (self._modules, links)

    @classmethod
    def made_of(
        cls, codegen: Any, kept: tuple[str, str, Any], part: Callable[[str], PartLibrary]
    ) -> Self:
        """Make it for this level of what `source` gave; `part` finds the function of a file."""
        name, _, (modules, links) = kept
        made = cls(codegen, name)
        made._made_of = kept
        for module in modules:
            made.add_llvm_module(binding.parse_bitcode(module))
        for link in links:  # as `finalize` does, and in its order
            if isinstance(link, str):
                other = part(link)._get_module_for_linking()  # noqa: SLF001
                made._final_module.link_in(other, preserve=True)
            else:
                made._final_module.link_in(binding.parse_bitcode(link))
        if lost := [each.name for each in made._final_module.functions if _is_lost(each)]:
            raise ValueError(f"has no {lost[0]}")  # which LLVM would end the process for
        made.finalize()
        return made


def _is_lost(function: Any) -> bool:
    return bool(function.is_declaration) and str(function.name).startswith(ITANIUM)


class PartLibrary(SourceLibrary):
    """A function that others take in, optimised, and not callable by itself."""

    kind = "source of a part"

    @property
    def codegen(self) -> Any:
        """What numba gives a function's Python environment to; there is none here."""
        return self

    def set_env(self, name: str, environment: Any) -> None:
        """Do nothing: only wrappers for Python read it."""

    def get_pointer_to_function(self, _name: str) -> int:
        """Optimise it, as numba does here; return that there is nothing to call."""
        self._ensure_finalized()
        return 0

    def serialize_using_object_code(self) -> None:
        """Do nothing: it has no machine code, and is made again of its source."""

    def _finalize_final_module(self) -> None:
        self._finalize_dynamic_globals()
        self._verify_declare_only_symbols()
        self._finalized = True


class ColdPartLibrary(PartLibrary):
    """A part that is no more than tidied, and optimised with what takes it in.

    For what decides: it is not called for each sample.
    """

    kind = "source of a cold part"

    def _optimize_final_module(self) -> None:
        """Leave this to what it becomes a part of."""


KINDS = {library.kind: library for library in (SourceLibrary, PartLibrary, ColdPartLibrary)}
