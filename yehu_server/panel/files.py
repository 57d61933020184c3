"""Writes the page as static files, which any web server can serve."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path

from yehu_server.ahead.kept import page_module
from yehu_server.errors import OutputError
from yehu_server.files import replacing, shipped_folder
from yehu_server.panel.beginnings import write_beginnings
from yehu_server.panel.facts import write

MODULE, CAPTURES = "yehu.wasm", "captures"
SERVED = {".css", ".html", ".js", ".svg", ".webmanifest"}
FACTS = "facts.js"
GENERATED = {FACTS, "examples.js"}


def page_files() -> Iterator[Path]:
    """The files of the page that are written by hand, relative to `page_folder`."""
    folder = page_folder()
    for path in sorted(folder.rglob("*")):
        if path.suffix in SERVED and path.name not in GENERATED:
            yield path.relative_to(folder)


def page_folder() -> Path:
    """The folder of the page."""
    return shipped_folder("web")


def write_page(folder: Path) -> list[Path]:
    """Write the whole page into a folder; return its files, relative to the folder.

    Raises
    ------
    OutputError
        Where one cannot be written.
    YehuError
        Where there is no WebAssembly module, and nothing to build it with.
    """
    module = page_module()
    files = list(page_files())
    try:
        for file in files:
            (folder / file).parent.mkdir(parents=True, exist_ok=True)
            _copy(page_folder() / file, folder / file)
        _copy(module, folder / MODULE)
        write(folder)
        written = write_beginnings(folder / CAPTURES)
        if (beside := module.with_name(FACTS)).is_file():  # of the module's own sources
            _copy(beside, folder / FACTS)
    except OSError as error:
        raise OutputError(f"{folder}: {error.strerror}") from error
    return [
        *files,
        *map(Path, sorted(GENERATED)),
        *(path.relative_to(folder) for path in written),
        Path(MODULE),
    ]


def _copy(source: Path, target: Path) -> None:
    with replacing(target) as partial:
        shutil.copyfile(source, partial)
