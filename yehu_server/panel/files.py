"""Writes the page as static files, which any web server can serve."""

from __future__ import annotations

import logging
import shutil
from collections.abc import Iterable, Iterator
from pathlib import Path

from yehu_server.ahead.kept import SHIPPED, page_module, shipped_version
from yehu_server.errors import OutputError, YehuError
from yehu_server.files import replacing, shipped_folder
from yehu_server.panel.beginnings import write_beginnings
from yehu_server.panel.facts import write

log = logging.getLogger(__name__)

MODULE, CAPTURES = "yehu.wasm", "captures"
SERVED = {".css", ".html", ".js", ".svg", ".webmanifest"}
FACTS = "facts.js"
GENERATED = {FACTS, "examples.js"}


def page_files() -> Iterator[Path]:
    """The files of the page that are written by hand, relative to `page_folder`."""
    for file in _files_of(page_folder()):
        if file.suffix in SERVED and file.name not in GENERATED:
            yield file


def page_folder() -> Path:
    """The folder of the page."""
    return shipped_folder("web")


def write_page(folder: Path) -> list[Path]:
    """Write the whole page into a folder; return its files, relative to the folder.

    Where its module cannot be built, it is the page that was shipped, as it was then: parameters
    and looks may lie elsewhere in a module of other sources.

    Raises
    ------
    OutputError
        Where one cannot be written.
    YehuError
        Where there is no WebAssembly module, and nothing to build it with.
    """
    try:
        module = page_module()
    except YehuError as error:
        if not (version := shipped_version()):
            raise
        log.warning("the page is that of version %s: %s", version, error)
        return _copy_all(_files_of(SHIPPED.parent), SHIPPED.parent, folder)
    written = _copy_all(page_files(), page_folder(), folder)
    try:
        _copy(module, folder / MODULE)
        write(folder)
        beginnings = write_beginnings(folder / CAPTURES)
    except OSError as error:
        raise OutputError(f"{folder}: {error.strerror}") from error
    written += [*map(Path, sorted(GENERATED)), Path(MODULE)]
    return [*written, *(path.relative_to(folder) for path in beginnings)]


def _files_of(folder: Path) -> Iterator[Path]:
    """All files of a folder, relative to it."""
    for path in sorted(folder.rglob("*")):
        if path.is_file():
            yield path.relative_to(folder)


def _copy_all(files: Iterable[Path], source: Path, folder: Path) -> list[Path]:
    """Copy files into another folder; return them."""
    copied = []
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for file in files:
            (folder / file).parent.mkdir(parents=True, exist_ok=True)
            _copy(source / file, folder / file)
            copied.append(file)
    except OSError as error:
        raise OutputError(f"{folder}: {error.strerror}") from error
    return copied


def _copy(source: Path, target: Path) -> None:
    with replacing(target) as partial:
        shutil.copyfile(source, partial)
