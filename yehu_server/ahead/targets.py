"""The machines that the instrument is compiled for, apart from the one that plays it live."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from llvmlite import binding

PAGE_FEATURES = "+simd128,+bulk-memory,+nontrapping-fptoint,+sign-ext,+mutable-globals"


@dataclass(frozen=True)
class Target:
    """A machine, by LLVM's names.

    Attributes
    ----------
    sets_mode : bool
        Whether it has the mode of this machine's processor that flushes denormal numbers.
    """

    triple: str
    cpu: str = ""
    features: str = ""
    sets_mode: bool = True
    reloc: str = "pic"

    def machine(self) -> Any:
        """LLVM's code generator for it."""
        binding.initialize_all_targets()
        binding.initialize_all_asmprinters()
        return binding.Target.from_triple(self.triple).create_target_machine(
            cpu=self.cpu, features=self.features, opt=3, reloc=self.reloc, codemodel="default"
        )


PAGE = Target("wasm32-unknown-unknown", "", PAGE_FEATURES, sets_mode=False, reloc="static")


def here(cpu: str = "generic") -> Target:
    """Tell this machine, with the instructions of a processor (LLVM's name) or any."""
    return Target(binding.get_process_triple(), cpu)
