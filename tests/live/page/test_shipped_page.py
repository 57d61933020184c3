"""Without a linker: a page is that of the last release, whole, or there is none; and a server's
page never mixes an older module with facts of now.
"""

import os
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from aiohttp import web
from live.page.browser import drive

from yehu_server.ahead import build
from yehu_server.ahead.build import page_module
from yehu_server.ahead.build_hash import build_hash, section_of, with_section
from yehu_server.errors import YehuError
from yehu_server.live.page import module_process, site
from yehu_server.live.page.site import Site, write_page

EMPTY = b"\0asm\1\0\0\0"
OLDER = {
    "index.html": b"the page of then",
    "facts.js": b"export default { builtFrom: 'of then' };",
    "captures/48000.json": b"{}",
    "yehu.wasm": with_section(EMPTY, "0.0.9 0123456789abcdef"),
}


@pytest.fixture
def shipped(tmp_path, monkeypatch) -> Path:
    """A folder with the page of an older release; no newer module is kept or can be built."""
    folder = tmp_path / "shipped"
    for name, content in OLDER.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(content)
    for module in (build, site):
        monkeypatch.setattr(module, "SHIPPED", folder / "yehu.wasm")
    monkeypatch.setattr(build, "data_folder", lambda: tmp_path)
    monkeypatch.setattr(build, "page_linker", lambda: None)
    return folder


def reported(monkeypatch) -> list[dict[str, Any]]:
    """The events of the process that finds a module for a server."""
    events: list[dict[str, Any]] = []
    send = lambda event, **details: events.append({"event": event, **details})  # noqa: E731
    monkeypatch.setattr(module_process, "Parent", lambda: SimpleNamespace(send=send))
    monkeypatch.setattr(module_process, "lower_priority", lambda _: None)
    module_process.main()
    return events


@pytest.mark.usefixtures("shipped")
def test_a_page_is_written_whole_as_it_was_shipped_and_its_version_reported(
    tmp_path, caplog
) -> None:
    written = write_page(tmp_path / "page")
    assert {str(file): (tmp_path / "page" / file).read_bytes() for file in written} == OLDER
    assert "the page is that of version 0.0.9: nothing is built" in caplog.text


def test_a_shipped_module_of_these_sources_goes_with_the_page_of_now(
    shipped, tmp_path, caplog
) -> None:
    (shipped / "yehu.wasm").write_bytes(with_section(EMPTY, f"9.9 {build_hash()}"))
    write_page(tmp_path / "page")
    assert build_hash() in (tmp_path / "page" / "facts.js").read_text("utf-8")
    module = (tmp_path / "page" / "yehu.wasm").read_bytes()
    assert section_of(module).split() == ["9.9", build_hash()]
    assert b"the page of then" not in (tmp_path / "page" / "index.html").read_bytes()
    assert not caplog.records


def test_a_server_offers_a_shipped_module_of_these_sources(shipped, monkeypatch) -> None:
    (shipped / "yehu.wasm").write_bytes(with_section(EMPTY, f"9.9 {build_hash()}"))
    assert reported(monkeypatch)[-1] == {"event": "module", "path": str(shipped / "yehu.wasm")}


def test_a_module_with_any_bit_wrong_is_none_of_these_sources(shipped, tmp_path) -> None:
    kept = tmp_path / f"page-{build_hash()}" / "yehu.wasm"
    kept.parent.mkdir()
    code = bytes((10, 40, *range(40)))  # a section of code
    whole = with_section(EMPTY + code, f"9.9 {build_hash()}")
    for path in (kept, shipped / "yehu.wasm"):
        path.write_bytes(whole)
        assert page_module() == path
        taken = []
        for bit in range(8 * len(whole)):
            flipped = bytearray(whole)
            flipped[bit // 8] ^= 1 << bit % 8
            path.write_bytes(flipped)
            taken += [bit] if build._found(kept.parent) == path else []
        for size in range(len(whole)):
            path.write_bytes(whole[:size])
            taken += [size] if build._found(kept.parent) == path else []
        for more in (bytes(100), code, whole):
            path.write_bytes(whole + more)
            taken += [more] if build._found(kept.parent) == path else []
        assert not taken, path


@pytest.mark.skipif(not hasattr(os, "getuid"), reason="no users")
@pytest.mark.usefixtures("shipped")
def test_no_module_is_taken_from_a_folder_that_others_may_write_to(tmp_path) -> None:
    kept = tmp_path / f"page-{build_hash()}" / "yehu.wasm"
    kept.parent.mkdir()
    kept.write_bytes(with_section(EMPTY, f"9.9 {build_hash()}"))
    kept.parent.chmod(0o777)
    with pytest.raises(YehuError, match="others may write there"):
        page_module()


# ---------------------------------------------------------------- while it is made


@pytest.mark.slow
def test_the_page_says_that_the_instrument_is_prepared_or_why_there_is_none(imitated) -> None:
    found = drive("page_loading.mjs", imitated)
    assert "Until then you see and hear what others play." in found["preparing"]
    assert found["answers"] == 3
    assert found["ready"] == {"notice": None, "plays": True}
    for said in (found["lacking"], found["lackingInChinese"]):
        assert "there is no wasm-ld here" in said
    assert found["lacking"].startswith("The instrument cannot be played")
    assert found["lackingInChinese"].startswith("本页不能演奏")
    assert found["without"]["plays"] is False
    assert found["without"]["drawings"] > 5


def test_a_server_says_that_the_module_comes_or_why_it_does_not() -> None:
    site, request = Site(), SimpleNamespace(path="/yehu.wasm", headers={})
    with pytest.raises(web.HTTPServiceUnavailable) as waits:
        site.answer(request)
    assert int(waits.value.headers["Retry-After"]) > 0
    site.set_no_module("there is no wasm-ld")
    with pytest.raises(web.HTTPNotFound) as lacks:
        site.answer(request)
    assert lacks.value.text == "there is no wasm-ld\n"
    assert lacks.value.content_type == "text/plain"
