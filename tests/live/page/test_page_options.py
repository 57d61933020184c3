"""Where `serve` offers the page, and what it says about it."""

from __future__ import annotations

from ipaddress import IPv4Interface

import pytest

from yehu_server import cli
from yehu_server.cli import serve_options
from yehu_server.cli.config import parse
from yehu_server.cli.report import page_lines
from yehu_server.cli.serve_options import options_of
from yehu_server.errors import ParameterError

LAN = "192.168.1.5"


@pytest.fixture(autouse=True)
def _lan(monkeypatch) -> None:
    monkeypatch.setattr(serve_options, "lan_interface", lambda: IPv4Interface(f"{LAN}/22"))


def page_of(*words: str):
    return options_of(parse(["serve", *words], cli._parser())).page


@pytest.mark.parametrize(
    ("words", "address", "is_wished"),
    [
        ([], ("127.0.0.1", 9002), False),
        (["--http", "127.0.0.1:9100"], ("127.0.0.1", 9101), False),
        (["--http", ":0"], ("127.0.0.1", 0), False),
        (["--http", ":65535"], ("127.0.0.1", 0), False),
        (["--panel-port", "8000"], ("127.0.0.1", 8000), True),
        (["--no-http", "--panel-port", "8000"], ("127.0.0.1", 8000), True),
        (["--lan"], ("0.0.0.0", 9002), False),  # noqa: S104 - nothing is bound
    ],
)
def test_the_page_is_beside_oscquery(words, address, is_wished) -> None:
    page = page_of(*words)
    assert (page.address, page.is_wished) == (address, is_wished)


@pytest.mark.parametrize("words", [["--no-panel"], ["--no-http"]])
def test_there_may_be_no_page(words) -> None:
    assert page_of(*words) is None


@pytest.mark.parametrize("words", [["--no-panel", "--lan"], ["--no-panel", "--open"]])
def test_no_page_cannot_be_opened(words) -> None:
    with pytest.raises(ParameterError, match="no page"):
        page_of(*words)


def test_the_lan_is_this_machines_network_and_nobody_else() -> None:
    assert list(page_of("--lan").networks) == ["192.168.0.0/22", "127.0.0.0/8", "::1"]
    assert list(page_of("--http-allow", "10.0.0.0/8").networks) == ["10.0.0.0/8"]
    narrow = page_of("--lan", "--http-allow", "192.168.1.64/26")
    assert list(narrow.networks) == ["192.168.1.64/26", "127.0.0.0/8", "::1"]


def test_what_is_said_tells_who_may_play() -> None:
    page = page_of("--lan")
    assert page_lines(*page.address, LAN, networks=page.networks) == [
        "the page at http://127.0.0.1:9002/",
        "on a phone: http://192.168.1.5:9002/",
        "anyone at 192.168.0.0/22 may play and listen, without a password",
    ]
    assert page_lines(LAN, 9002, LAN, networks=[]) == [
        "the page at http://192.168.1.5:9002/",
        "anyone on this network may play and listen, without a password",
    ]
    assert page_lines("127.0.0.1", 9002, LAN, networks=[])[1].endswith("yehu-server serve --lan")
