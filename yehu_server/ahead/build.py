"""Compile and link the instrument for pages and for C programs, in a process of its own.

A process compiles for one level of processors, so another level's code is made in another process:
`python -m yehu_server.ahead.build`.
"""

import logging
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from yehu_server.ahead import interface
from yehu_server.ahead.build_hash import build_hash, section_of, with_section
from yehu_server.ahead.header import header
from yehu_server.ahead.interpreter import INTERPRETER
from yehu_server.ahead.memory_images import image
from yehu_server.ahead.module import PAGE, Target, here, joined
from yehu_server.compile import levels
from yehu_server.compile.cache_folder import OTHERS, data_folder
from yehu_server.errors import OutputError, YehuError
from yehu_server.system.files import LIBRARY, linker_options, may_others_write
from yehu_server.util import __version__
from yehu_server.util.files import error_reason, write_bytes
from yehu_server.util.hints import install_command
from yehu_server.util.processes import machine_lock, python_command

log = logging.getLogger(__name__)

PAGE_FILE, HEADER_FILE = "yehu.wasm", "yehu.h"
LIBRARY_FILE = LIBRARY.format("yehu")
WHATS = ("wasm", "library")
RATES = (44100.0, 48000.0)  # Hz
PAGE_LINKERS = ("wasm-ld", *(f"wasm-ld-{version}" for version in range(22, 13, -1)))
LIBRARY_LINKERS = ("cc", "gcc", "clang")
HAVE_IT = f"Debian's package {{}} has it, and so has zig: {install_command('plugin')}"
STACK_BYTES = 1 << 18


def page_linker() -> list[str] | None:
    """The command of LLVM's linker for WebAssembly, or of zig, which has it; None without them."""
    return _first(PAGE_LINKERS, "wasm-ld")


def linker_of(what: str) -> list[str]:
    """The command that links ``wasm`` or a ``library``; raises YehuError if there is none."""
    linker = page_linker() if what == "wasm" else _first(LIBRARY_LINKERS, "cc")
    if linker is not None:
        return linker
    if what == "wasm":
        raise YehuError(f"there is no wasm-ld here; {HAVE_IT.format('lld')}")
    raise YehuError(f"there is no C compiler here; {HAVE_IT.format('gcc')}")


def zig(tool: str) -> list[str] | None:
    """The command of one of zig's tools, where its package is installed."""
    return None if find_spec("ziglang") is None else [sys.executable, "-m", "ziglang", tool]


def link_page(linker: Sequence[str], code: Path, exports: Iterable[str], into: Path) -> None:
    """Link an object file into a WebAssembly module with its own memory; raises YehuError."""
    options = [
        "--no-entry",
        "--allow-undefined",  # what it needs of the page; `module.joined` has checked it
        "--strip-all",
        "--export=__heap_base",
        "-z",
        f"stack-size={STACK_BYTES}",
        *(f"--export={name}" for name in exports),
    ]
    run_compiler([*linker, *options, str(code), "-o", str(into)])


def link_library(linker: Sequence[str], code: Path, into: Path) -> None:
    """Link an object file into a shared library; raises YehuError where it fails."""
    options = ["-shared", "-s", *linker_options(into.name)]
    run_compiler([*linker, *options, str(code), "-o", str(into)])


def _first(names: Iterable[str], of_zig: str) -> list[str] | None:
    found = next((path for path in map(shutil.which, names) if path is not None), None)
    return zig(of_zig) if found is None else [found]


def run_compiler(command: Sequence[str]) -> None:
    """Run a compiler or linker; raises YehuError, with what it said, where it fails."""
    done = subprocess.run(command, capture_output=True, text=True, check=False)  # noqa: S603 - ours
    if done.returncode != 0:
        raise YehuError(f"{Path(command[0]).name}: {done.stderr.strip() or done.returncode}")


def build(
    what: str, folder: Path, *, rates: Sequence[float] = RATES, level: str | None = None
) -> list[Path]:
    """Build one of WHATS into a folder; return the files written.

    Raises YehuError where something is missing to build with, or the folder cannot be written.

    `rates`: sample rates (Hz) at which an instrument can be made.
    `level`: the level of processors of a library; by default the lowest.
    """
    linker_of(what)  # or there would be none after minutes of compiling
    level = levels.lowest() if level is None else levels.checked(level)
    words = (what, str(folder), *map(repr, rates))
    done = compile_for(level, "yehu_server.ahead.build", *words)
    return [Path(line) for line in done.splitlines()]


def compile_for(level: str, module: str, *words: str) -> str:
    """Run a module in a process that compiles for a level; return what it prints.

    Raises YehuError with the last line of what it said, where it fails.
    """
    environment = {**os.environ, levels.VARIABLE: level}
    command = python_command(module, *words)
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)  # noqa: S603 - our own
    if done.returncode != 0:
        raise YehuError(done.stderr.strip().rpartition("\n")[2] or f"exit code {done.returncode}")
    return done.stdout


def build_here(what: str, folder: Path, rates: Sequence[float]) -> list[Path]:
    """Build in this process, for the level that it compiles for; see `build`."""
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
                return [write_bytes(folder / PAGE_FILE, module)]
            code.write_bytes(compiled(functions, here()))
            linked = linked.with_name(LIBRARY_FILE)
            link_library(linker, code, linked)
            text = header(functions, version=__version__, sources=build_hash(), rates=rates)
            return [
                write_bytes(folder / LIBRARY_FILE, linked.read_bytes()),
                write_bytes(folder / HEADER_FILE, text.encode()),
            ]
    except OSError as error:
        raise OutputError(f"{folder}: {error_reason(error)}") from error


def compiled(functions: Sequence[Any], target: Target) -> bytes:
    """An object file of functions for a machine."""
    code: bytes = target.machine().emit_object(joined(functions, target))
    return code


# Of the last release, with the whole page of then around it.
SHIPPED = Path(__file__).parent / "shipped" / PAGE_FILE


def page_module() -> Path:
    """The WebAssembly module of the present sources.

    It is built where it was not yet, which takes a minute and needs a linker. Raises YehuError
    where it cannot be built.
    """
    folder = data_folder() / f"page-{build_hash()}"
    if found := _found(folder):
        return found
    if _is_others(folder):
        raise YehuError(f"{folder}: {OTHERS}")
    if page_linker() is None:
        raise YehuError(
            f"nothing is built for pages, and there is no wasm-ld; {HAVE_IT.format('lld')}"
        )
    with machine_lock(data_folder(), "page"):  # who waits finds it then
        if found := _found(folder):
            return found
        log.warning("compiling the instrument for pages (about a minute), once ...")
        return build("wasm", folder)[0]


def _is_others(folder: Path) -> bool:
    """Whether others may write to a folder, where it is there."""
    return folder.is_dir() and may_others_write(folder)


def _found(folder: Path) -> Path | None:
    """The module of the present sources, as shipped or in a folder that is one's own."""
    for path in (SHIPPED, folder / PAGE_FILE):
        if path == folder / PAGE_FILE and _is_others(folder):
            continue
        if path.is_file() and _made(path)[-1:] == [build_hash()]:
            return path
    return None


def shipped_version() -> str:
    """The version of the page that was shipped; empty where there is none."""
    return next(iter(_made(SHIPPED)), "") if SHIPPED.is_file() else ""


def _made(module: Path) -> list[str]:
    """The version and the sources that a module was made of."""
    return section_of(module.read_bytes()).split()


if __name__ == "__main__":
    try:
        _what, _folder, *_rates = sys.argv[1:]
        for _path in build_here(_what, Path(_folder), [float(rate) for rate in _rates]):
            sys.stdout.write(f"{_path}\n")
    except YehuError as error:
        sys.exit(str(error))
