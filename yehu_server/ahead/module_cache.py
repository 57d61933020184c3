"""The WebAssembly module that pages get: as shipped, or built once."""

from __future__ import annotations

import logging
from pathlib import Path

from yehu_server.ahead.build import PAGE_FILE, build, page_linker
from yehu_server.ahead.build_hash import build_hash, section_of
from yehu_server.compile.cache_folder import data_folder
from yehu_server.errors import YehuError
from yehu_server.util.processes import machine_lock

log = logging.getLogger(__name__)

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
    if page_linker() is None:
        raise YehuError("nothing is built for pages, and there is no wasm-ld; Debian's lld has it")
    with machine_lock("-page"):  # who waits finds it then
        if found := _found(folder):
            return found
        log.warning("compiling the instrument for pages; it takes a minute, once")
        return build("wasm", folder)[0]


def _found(folder: Path) -> Path | None:
    """The module of the present sources, as shipped or in a folder."""
    for path in (SHIPPED, folder / PAGE_FILE):
        if path.is_file() and _made(path)[-1:] == [build_hash()]:
            return path
    return None


def shipped_version() -> str:
    """The version of the page that was shipped; empty where there is none."""
    return next(iter(_made(SHIPPED)), "") if SHIPPED.is_file() else ""


def _made(module: Path) -> list[str]:
    """The version and the sources that a module was made of."""
    return section_of(module.read_bytes()).split()
