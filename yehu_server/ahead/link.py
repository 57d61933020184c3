"""Link compiled code into a WebAssembly module, or a shared library."""

from __future__ import annotations

import shutil
import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path

from yehu_server.errors import YehuError

PAGE_LINKERS = ("wasm-ld", *(f"wasm-ld-{version}" for version in range(22, 13, -1)))
LIBRARY_LINKERS = ("cc", "gcc", "clang")
STACK_BYTES = 1 << 18


def page_linker() -> str | None:
    """The path of LLVM's linker for WebAssembly, where there is one."""
    return _first(PAGE_LINKERS)


def linker_of(what: str) -> str:
    """The path of the linker for ``wasm`` or a ``library``.

    Raises YehuError where there is none.
    """
    linker = page_linker() if what == "wasm" else _first(LIBRARY_LINKERS)
    if linker is not None:
        return linker
    if what == "wasm":
        raise YehuError("there is no wasm-ld here; Debian's package lld has it")
    raise YehuError("there is no C compiler here, whose linker makes the library")


def link_page(linker: str, code: Path, exports: Iterable[str], into: Path) -> None:
    """Link an object file into a WebAssembly module with its own memory.

    Raises YehuError where it fails.
    """
    options = [
        "--no-entry",
        "--allow-undefined",  # what it needs of the page; `module.joined` has checked it
        "--strip-all",
        "--export=__heap_base",
        "-z",
        f"stack-size={STACK_BYTES}",
        *(f"--export={name}" for name in exports),
    ]
    _run([linker, *options, str(code), "-o", str(into)])


def link_library(linker: str, code: Path, into: Path) -> None:
    """Link an object file into a shared library; raises YehuError where it fails."""
    options = ["-shared", "-s"]
    if sys.platform == "linux":
        options += ["-Wl,--build-id=none", f"-Wl,-soname,{into.name}"]
    _run([linker, *options, str(code), "-lm", "-o", str(into)])


def _first(names: Iterable[str]) -> str | None:
    return next((path for path in map(shutil.which, names) if path is not None), None)


def _run(command: list[str]) -> None:
    done = subprocess.run(command, capture_output=True, text=True, check=False)  # noqa: S603 - ours
    if done.returncode != 0:
        raise YehuError(f"{Path(command[0]).name}: {done.stderr.strip() or done.returncode}")
