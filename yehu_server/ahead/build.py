"""Compile and link the instrument for pages and for C programs, in a process of its own.

numba compiles for one processor in a process, so another one's code is made in another process:
`python -m yehu_server.ahead.build`.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from yehu_server.ahead import interface
from yehu_server.ahead.build_hash import build_hash, with_section
from yehu_server.ahead.header import header
from yehu_server.ahead.interpreter import INTERPRETER
from yehu_server.ahead.memory_images import image
from yehu_server.ahead.module import PAGE, Target, here, joined
from yehu_server.errors import OutputError, ParameterError, YehuError
from yehu_server.util import __version__
from yehu_server.util.files import replacing
from yehu_server.util.processes import python_command

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


PAGE_FILE, HEADER_FILE = "yehu.wasm", "yehu.h"
LIBRARY_FILE = "libyehu.dylib" if sys.platform == "darwin" else "libyehu.so"
WHATS = ("wasm", "library")
RATES = (44100.0, 48000.0)  # Hz
ANY = "generic"  # processor
STRANGE = "is not a recognized processor"  # LLVM's word


def build(what: str, folder: Path, *, rates: Sequence[float] = RATES, cpu: str = ANY) -> list[Path]:
    """Build one of WHATS into a folder; return the files written.

    Raises YehuError where something is missing to build with, or the folder cannot be written.

    `rates`: sample rates (Hz) at which an instrument can be made.
    `cpu`: the processor of a library, by LLVM's name.
    """
    linker_of(what)  # or there would be none after minutes of compiling
    command = python_command("yehu_server.ahead.build", what, str(folder), cpu)
    command += [f"{rate!r}" for rate in rates]
    environment = {**os.environ, "NUMBA_CPU_NAME": cpu, "NUMBA_CPU_FEATURES": ""}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)  # noqa: S603 - our own
    if STRANGE in done.stderr:
        raise ParameterError(f"{cpu!r} is no processor that LLVM knows")
    if done.returncode != 0:
        raise YehuError(done.stderr.strip().rpartition("\n")[2] or f"exit code {done.returncode}")
    return [Path(line) for line in done.stdout.splitlines()]


def build_here(what: str, folder: Path, cpu: str, rates: Sequence[float]) -> list[Path]:
    """Build in this process, which compiles for the processor wanted; see `build`."""
    linker = linker_of(what)
    functions = interface.functions(rates, [image(rate) for rate in rates], build_hash())
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory() as scratch:
            code, linked = Path(scratch) / "yehu.o", Path(scratch) / "linked"
            if what == "wasm":
                functions += INTERPRETER
                code.write_bytes(compiled(functions, PAGE))
                link_page(linker, code, [function.name for function in functions], linked)
                module = with_section(linked.read_bytes(), f"{__version__} {build_hash()}")
                return [_written(folder / PAGE_FILE, module)]
            code.write_bytes(compiled(functions, here(cpu)))
            linked = linked.with_name(LIBRARY_FILE)
            link_library(linker, code, linked)
            text = header(functions, version=__version__, sources=build_hash(), rates=rates)
            return [
                _written(folder / LIBRARY_FILE, linked.read_bytes()),
                _written(folder / HEADER_FILE, text.encode()),
            ]
    except OSError as error:
        raise OutputError(f"{folder}: {error.strerror}") from error


def compiled(functions: Sequence[Any], target: Target) -> bytes:
    """An object file of functions for a machine."""
    code: bytes = target.machine().emit_object(joined(functions, target))
    return code


def _written(path: Path, content: bytes) -> Path:
    with replacing(path) as partial:
        partial.write_bytes(content)
    return path


if __name__ == "__main__":
    try:
        _what, _folder, _cpu, *_rates = sys.argv[1:]
        for _path in build_here(_what, Path(_folder), _cpu, [float(rate) for rate in _rates]):
            sys.stdout.write(f"{_path}\n")
    except YehuError as error:
        sys.exit(str(error))
