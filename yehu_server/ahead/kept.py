"""The WebAssembly module that pages get: built once, or as shipped."""

from __future__ import annotations

import logging
from pathlib import Path

from yehu_server.ahead.build import PAGE_FILE, build
from yehu_server.ahead.link import page_linker
from yehu_server.ahead.section import section_of
from yehu_server.ahead.sources import sources_hash
from yehu_server.errors import YehuError
from yehu_server.jit import data_folder

log = logging.getLogger(__name__)

# Of the last release, with the facts of its sources beside it.
SHIPPED = Path(__file__).parent / "shipped" / PAGE_FILE


def page_module() -> Path:
    """The WebAssembly module of the present sources, or else the one shipped.

    It is built where it was not yet, which takes a minute and needs a linker.

    Raises
    ------
    YehuError
        Where there is none, and nothing to build it with.
    """
    folder = data_folder() / f"page-{sources_hash()}"
    kept = folder / PAGE_FILE
    for path in (SHIPPED, kept):
        if path.is_file() and section_of(path.read_bytes()).split()[-1:] == [sources_hash()]:
            return path
    if page_linker() is not None:
        log.warning("compiling the instrument for pages; it takes a minute, once")
        return build("wasm", folder)[0]
    if SHIPPED.is_file():
        version = section_of(SHIPPED.read_bytes()).split()[0]
        log.warning("the page plays version %s: there is no wasm-ld to build a newer one", version)
        return SHIPPED
    raise YehuError("nothing is built for pages, and there is no wasm-ld; Debian's lld has it")
