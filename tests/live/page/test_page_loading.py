"""What the page says and does while the instrument is prepared, and where there is none."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from aiohttp import web
from live.page.browser import drive, missing, served

from yehu_server.live.page.site import Site

pytestmark = pytest.mark.slow

in_browser = pytest.mark.skipif(missing() is not None, reason=str(missing()))


@pytest.fixture(scope="module")
def found(tmp_path_factory) -> Any:
    """What the page said and did."""
    with served(tmp_path_factory.mktemp("generated")) as url:
        return drive("page_loading.mjs", url)


@in_browser
def test_while_it_is_prepared_the_page_says_so_and_asks_again(found) -> None:
    assert "still preparing" in found["preparing"]
    assert found["answers"] == 3
    assert found["ready"] == {"notice": None, "plays": True}


@in_browser
def test_where_there_is_none_the_page_says_why_and_shows_its_pictures(found) -> None:
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
