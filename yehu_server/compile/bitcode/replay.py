"""Makes machine code for this processor of shipped bitcode, as numba would have made it.

A process of its own: what LLVM does not survive costs only the fallback. It needs numba's back
end and none of our code, so it starts at once, and loads nothing of what it makes.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from llvmlite import binding
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler_lock import global_compiler_lock
from numba.core.registry import cpu_target

from yehu_server.compile.bitcode.shipped import Shipped, read_shipped
from yehu_server.compile.cache import payload_of
from yehu_server.util.sealed import write_sealed


class Replayed(JITCodeLibrary):  # type: ignore[misc]
    """numba's library: linked, optimised and compiled as ever, but not loaded into this process."""

    def __init__(self, codegen: Any, name: str, bitcode: bytes) -> None:
        super().__init__(codegen, name)
        self._final_module = binding.parse_bitcode(bitcode)
        self._machine_code = b""

    def _finalize_final_module(self) -> None:
        # Also of what is only linked into others: this changes the module, and so what they are
        # made of. Without it the samples are others, on some processors.
        self._machine_code = self._codegen._tm.emit_object(self._final_module)  # noqa: SLF001
        self._finalized = True

    @property
    def kept(self) -> tuple[str, str, tuple[bytes, bytes]]:
        """What numba's cache keeps of a library: its machine code, and what it was made of."""
        shared = self._get_module_for_linking().as_bitcode()
        return self.name, "object", (self._machine_code, shared)


def replay(shipped: Shipped, files: Mapping[str, Path]) -> None:
    """Make the machine code of some exports, each into its file of the cache.

    Raises
    ------
    OSError
        Where a file cannot be written.
    RuntimeError
        Where LLVM refuses the bitcode.
    """
    codegen = cpu_target.target_context.codegen()
    made: dict[int, Replayed] = {}
    with global_compiler_lock:
        for index in shipped.needed(files):
            library = shipped.libraries[index]
            made[index] = Replayed(codegen, library.name, library.bitcode)
            for link in library.links:
                made[index].add_linking_library(made[link])
            made[index].finalize()
        for name, file in files.items():
            export = shipped.exports[name]
            write_sealed(file, payload_of(made[export.library].kept, export.rest))


if __name__ == "__main__":
    source, sources, *pairs = sys.argv[1:]
    replay(
        read_shipped(Path(source), sources),
        dict(zip(pairs[::2], map(Path, pairs[1::2]), strict=True)),
    )
