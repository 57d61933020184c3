"""The address as a QR code in a terminal: a camera reads it, on dark and on light terminals."""

from __future__ import annotations

import io
import re

import segno

from yehu_server.cli.page import BLACK_ON_WHITE, PLAIN, QUIET, drawn, show
from yehu_server.cli.report import page_for_phones

URL = "http://192.168.1.5:9002/"
LAN = "192.168.1.5"


# As Unicode names them: upper half, lower half, full block.
SHOWN = {" ": (0, 0), "\u2580": (1, 0), "\u2584": (0, 1), "\u2588": (1, 1)}


class Stream(io.StringIO):
    def __init__(self, encoding: str, *, is_terminal: bool) -> None:
        super().__init__()
        self._encoding = encoding
        self._is_terminal = is_terminal

    @property
    def encoding(self) -> str:
        return self._encoding

    def isatty(self) -> bool:
        return self._is_terminal


def modules(lines: list[str]) -> list[list[int]]:
    """The black modules, as a terminal shows them."""
    rows = []
    for line in lines:
        signs = line.removeprefix(BLACK_ON_WHITE).removesuffix(PLAIN)
        rows += [[SHOWN[sign][half] for sign in signs] for half in (0, 1)]
    return rows


def test_its_modules_are_those_of_the_code_within_a_quiet_zone() -> None:
    expected = [list(row) for row in segno.make_qr(URL).matrix_iter(border=QUIET)]
    found = modules(drawn(URL))
    assert found[: len(expected)] == expected
    assert not any(map(any, found[len(expected) :]))
    assert not any(map(any, found[:QUIET]))
    assert not any(row[0] or row[QUIET - 1] or row[-1] or row[-QUIET] for row in found)


def test_it_is_black_on_white_whatever_the_terminals_colours() -> None:
    for line in drawn(URL):
        colours = re.findall(r"\x1b\[([\d;]*)m", line)
        assert colours == ["38;5;16;48;5;231", "0"]
        assert line.startswith("\x1b")
        assert line.endswith("\x1b[0m")


def test_it_is_small() -> None:
    lines = drawn(URL)
    assert len(lines) <= 18
    assert {len(line) - len(BLACK_ON_WHITE + PLAIN) for line in lines} == {33}


def test_only_a_terminal_that_shows_it_gets_it() -> None:
    file = Stream("utf-8", is_terminal=False)
    old = Stream("iso-8859-1", is_terminal=True)
    terminal = Stream("UTF-8", is_terminal=True)
    for stream in (file, old, terminal):
        show(URL, stream)
    assert file.getvalue() == old.getvalue() == ""
    assert terminal.getvalue().splitlines() == drawn(URL)


def test_the_address_is_one_that_phones_reach() -> None:
    assert page_for_phones("0.0.0.0", 9002, LAN) == URL  # noqa: S104
    assert page_for_phones(LAN, 9002, LAN) == URL
    assert page_for_phones("127.0.0.1", 9002, LAN) == ""
    assert page_for_phones("::1", 9002, LAN) == ""
