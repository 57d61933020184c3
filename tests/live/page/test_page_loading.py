"""What the page says and does while the instrument is prepared, and where there is none."""

from __future__ import annotations

from types import SimpleNamespace

import pytest
from aiohttp import web
from live.page.browser import drive

from yehu_server.live.page.site import Site

pytestmark = pytest.mark.slow


def test_the_page_says_that_the_instrument_is_prepared_or_why_there_is_none(imitated) -> None:
    found = drive("page_loading.mjs", imitated)
    assert "still preparing" in found["preparing"]
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
