"""Where `serve` offers the page and to whom, what it says of it, and the address as a QR code."""

import ipaddress
import webbrowser
from ipaddress import IPv4Interface

import pytest
import segno

from yehu_server import cli
from yehu_server.cli import serve_options
from yehu_server.cli.config import parse
from yehu_server.cli.page import PLAIN, WHITE_ON_BLACK, drawn, open_in_browser
from yehu_server.cli.report import connect_lines, page_for_phones
from yehu_server.cli.serve_options import options_of
from yehu_server.live.network import ANYWHERE
from yehu_server.live.page import site
from yehu_server.live.page.guests import ROLES, Guests

ALL, HERE, LAN = "0.0.0.0", "127.0.0.1", "192.168.1.5"  # noqa: S104 - nothing is bound
URL = f"http://{LAN}:9002/"


@pytest.fixture(autouse=True)
def _lan(monkeypatch) -> None:
    monkeypatch.setattr(serve_options, "lan_interface", lambda: IPv4Interface(f"{LAN}/22"))


def page_of(words: str):
    return options_of(parse(["serve", *words.split()], cli._parser())).page


def test_the_page_is_beside_oscquery_or_where_it_is_requested() -> None:
    for words, address, is_required in [
        ("", (HERE, 9002), False),
        ("--http 127.0.0.1:9100", (HERE, 9101), False),
        ("--http :0", (HERE, 0), False),
        ("--http :65535", (HERE, 0), False),
        ("--panel-port 8000", (HERE, 8000), True),
        ("--no-http --panel-port 8000", (HERE, 8000), True),
        ("--lan", (ALL, 9002), False),
    ]:
        page = page_of(words)
        assert (page.address, page.is_required) == (address, is_required), words


def test_the_lan_is_this_machines_network_and_nobody_else() -> None:
    assert list(page_of("--lan").networks) == ["192.168.0.0/22", "127.0.0.0/8", "::1"]
    assert list(page_of("--http-allow 10.0.0.0/8").networks) == ["10.0.0.0/8"]
    narrow = page_of("--lan --http-allow 192.168.1.64/26")
    assert list(narrow.networks) == ["192.168.1.64/26", "127.0.0.0/8", "::1"]


def test_guests_are_what_the_option_says_or_a_config_file(tmp_path, capsys) -> None:
    assert page_of("").guests is None
    assert page_of("--lan").guests.role == page_of("--lan --open").guests.role == "play"
    assert tuple(page_of(f"--lan={role}").guests.role for role in ROLES) == tuple(ROLES)
    file = tmp_path / "serve.toml"
    for text, role in [("true", "play"), ('"listen"', "listen"), ("false", None)]:
        file.write_text(f"lan = {text}\n")
        guests = page_of(f"--config {file}").guests
        assert (guests and guests.role) == role
    with pytest.raises(SystemExit):
        page_of("--lan=admin")
    assert "is not one of" in (err := capsys.readouterr().err)
    assert err.count("\n") == 1


def test_the_address_for_phones_is_one_that_they_reach_with_the_pin() -> None:
    found = [page_for_phones(host, 9002, LAN) for host in (ALL, LAN, HERE, "::1")]
    assert found == [URL, URL, "", ""]
    assert page_for_phones(ALL, 9002, LAN, Guests("listen", "012345")) == f"{URL}?pin=012345"


# ---------------------------------------------------------------- the QR code

QUIET = 4  # modules of white around it (ISO/IEC 18004)
# Upper half, lower half, full block, as Unicode names them, are white.
SHOWN = {" ": (1, 1), "\u2580": (0, 1), "\u2584": (1, 0), "\u2588": (0, 0)}


def modules(lines: list[str]) -> list[list[int]]:
    """The black modules, as a terminal shows them."""
    rows = []
    for line in lines:
        signs = line.removeprefix(WHITE_ON_BLACK).removesuffix(PLAIN)
        rows += [[SHOWN[sign][half] for sign in signs] for half in (0, 1)]
    return rows


def test_its_modules_are_those_of_the_code_within_a_quiet_zone() -> None:
    expected = [list(row) for row in segno.make_qr(URL).matrix_iter(border=QUIET)]
    found = modules(drawn(URL))
    assert found[: len(expected)] == expected
    assert not any(map(any, found[:QUIET]))
    assert not any(
        row[0] or row[QUIET - 1] or row[-1] or row[-QUIET] for row in found[: len(expected)]
    )


def test_a_public_page_is_named_by_its_address_and_links_of_the_page_have_it(
    tmp_path, monkeypatch, capsys
) -> None:
    module = tmp_path / "yehu.wasm"
    module.write_bytes(b"")
    monkeypatch.setattr(site, "page_module", lambda: module)
    told = '<meta name="yehu-share" content="https://example.org/yehu/">'
    for words, count in ([], 0), (["--share-url", "https://example.org/yehu/"], 1):
        assert cli.main(["page", "-o", str(tmp_path / "page"), *words]) == 0
        assert (tmp_path / "page" / "index.html").read_text("utf-8").count(told) == count
    for wrong in ("example.org", "ftp://example.org/", "https://", "https://example.org/?pin=1"):
        with pytest.raises(SystemExit):
            cli.main(["page", "--share-url", wrong])
        assert "expected one such as https://host/yehu/" in capsys.readouterr().err


def test_where_osc_is_heard_and_where_it_is_not_is_said():
    lan = ipaddress.ip_interface("192.168.1.5/24")
    deaf = "programs of this machine send to 192.168.1.5 too, not to 127.0.0.1; --osc 0.0.0.0:9000"
    for host, is_deaf in (("192.168.1.5", True), (ANYWHERE, False), ("127.0.0.1", False)):
        lines = connect_lines(host, 9000, lan, is_open=False)
        assert any(line.startswith(deaf) for line in lines) == is_deaf


def test_who_opens_the_page_without_a_browser_is_told_where_it_is(monkeypatch, capsys):
    for is_there in (True, False):
        monkeypatch.setattr(webbrowser, "open", lambda _url, found=is_there: found)
        open_in_browser("http://127.0.0.1:9002/")
        assert ("open http://127.0.0.1:9002/ in one" in capsys.readouterr().err) != is_there
