"""What functions are compiled to that only become parts of others: no machine code.

numba makes machine code of each function, also where its callers take in all of it. That would be
a tenth of the time that compiling takes.
"""

from __future__ import annotations

from typing import Any, Self

from llvmlite import binding
from numba.core.codegen import JITCodeLibrary

BITCODE_OF_PART = "bitcode of a part"  # as numba names what it keeps a library as


class PartLibrary(JITCodeLibrary):  # type: ignore[misc]
    """A function that others take in, optimised, and not callable by itself."""

    @classmethod
    def kept_as(cls, codegen: Any, kept: tuple[str, str, bytes]) -> Self:
        """Make it again of what `serialize_using_object_code` gave."""
        name, _, bitcode = kept
        part = cls(codegen, name)
        part._final_module = binding.parse_bitcode(bitcode)
        part._finalized = True
        return part

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

    def serialize_using_object_code(self) -> tuple[str, str, bytes]:
        """What the cache keeps, in the place of machine code."""
        return self.name, BITCODE_OF_PART, self._get_module_for_linking().as_bitcode()

    def _finalize_final_module(self) -> None:
        self._finalize_dynamic_globals()
        self._verify_declare_only_symbols()
        self._finalized = True
