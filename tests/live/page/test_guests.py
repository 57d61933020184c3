"""Guests of a server in the local network: what each may do, and the PIN that lets them in."""

from __future__ import annotations

import asyncio
from ipaddress import IPv4Interface

import numpy as np
import pytest
from aiohttp import WSMsgType, web
from aiohttp.test_utils import TestClient, TestServer
from wire import StillTime

from yehu_server import cli
from yehu_server.cli import serve_options
from yehu_server.cli.config import parse
from yehu_server.cli.report import page_for_phones, page_lines
from yehu_server.cli.serve_options import options_of
from yehu_server.core.midi.events import LEAVE, RELEASE_ALL
from yehu_server.core.player.rows import ROW
from yehu_server.core.player.wishes import BEGIN, DRAW, EXPRESS, HOLD, STOP, WRITE
from yehu_server.live.page import guests as admitting
from yehu_server.live.page.guests import DIGITS, ROLES, TRIES, Admission, Guests, new_pin
from yehu_server.live.page.players import permitted
from yehu_server.live.page.sockets import NO_PIN, PageSockets

HOST, ELSEWHERE = "127.0.0.1", "192.0.2.7"


# ---------------------------------------------------------------- options


@pytest.fixture(autouse=True)
def _lan(monkeypatch) -> None:
    monkeypatch.setattr(serve_options, "lan_interface", lambda: IPv4Interface("192.168.1.5/22"))


def page_of(*words: str):
    return options_of(parse(["serve", *words], cli._parser())).page


@pytest.mark.parametrize(
    ("words", "role"),
    [(["--lan"], "play"), (["--lan", "--open"], "play"), *(([f"--lan={r}"], r) for r in ROLES)],
)
def test_guests_are_what_the_option_says(words, role) -> None:
    assert page_of(*words).guests.role == role


def test_without_the_option_there_are_no_guests() -> None:
    assert page_of().guests is None


@pytest.mark.parametrize(("text", "role"), [("true", "play"), ('"listen"', "listen"), ("false", 0)])
def test_a_config_file_may_say_it_too(tmp_path, text, role) -> None:
    file = tmp_path / "serve.toml"
    file.write_text(f"lan = {text}\n")
    found = page_of("--config", str(file)).guests
    assert found is None if role == 0 else found.role == role


def test_a_role_that_there_is_not_is_told(capsys) -> None:
    with pytest.raises(SystemExit):
        page_of("--lan=admin")
    assert "choose from" in (err := capsys.readouterr().err)
    assert err.count("\n") == 1


def test_the_address_for_phones_carries_the_pin() -> None:
    guests = Guests("listen", "012345")
    assert page_for_phones("0.0.0.0", 9002, "192.168.1.5", guests) == (  # noqa: S104
        "http://192.168.1.5:9002/?pin=012345"
    )
    lines = page_lines("0.0.0.0", 9002, "192.168.1.5", networks=["192.168.0.0/22"], guests=guests)  # noqa: S104
    assert lines[0] == "the page at http://127.0.0.1:9002/"
    assert lines[2] == "whoever at 192.168.0.0/22 has the PIN 012345 may listen"


def test_each_server_has_a_pin_of_its_own() -> None:
    pins = {new_pin() for _ in range(50)}
    assert len(pins) > 45
    assert all(len(pin) == DIGITS and pin.isdecimal() for pin in pins)


# ---------------------------------------------------------------- the PIN


@pytest.fixture
def clock(monkeypatch) -> StillTime:
    clock = StillTime(1000.0)
    monkeypatch.setattr(admitting, "time", clock)
    return clock


@pytest.fixture
def admission(clock) -> Admission:
    del clock
    return Admission(Guests("play", "123456"))


def test_this_machine_owns_the_server_without_a_pin(admission) -> None:
    assert admission.role_of(HOST, "") == "own"


def test_another_machine_needs_the_pin(admission) -> None:
    assert admission.role_of(ELSEWHERE, "") is None
    assert admission.role_of(ELSEWHERE, "123457") is None
    assert admission.role_of(ELSEWHERE, "\u0661" * 6) is None
    assert admission.role_of(ELSEWHERE, "123456") == "play"


def test_without_guests_all_may_do_all() -> None:
    assert Admission(None).role_of(ELSEWHERE, "") == "own"


def test_who_guesses_has_to_wait_and_others_do_not(admission, clock) -> None:
    for _ in range(TRIES):
        assert admission.role_of(ELSEWHERE, "000000") is None
    assert admission.role_of(ELSEWHERE, "123456") is None
    assert admission.role_of("192.0.2.8", "123456") == "play"
    clock.now += admitting.ANOTHER_AFTER_S + 0.1
    assert admission.role_of(ELSEWHERE, "123456") == "play"


# ---------------------------------------------------------------- roles

WISHES = {
    "a note": (BEGIN, 1, 69.0),
    "its value": (EXPRESS, ROW["/playing/pressure"], 0.4),
    "a controller": (WRITE, ROW["/playing/vibrato"], 20.0),
    "a bow": (DRAW, 0, 0.2),
    "the room": (WRITE, ROW["/room/size"], 20.0),
    "the body": (WRITE, ROW["/body/gain"], 1.0),
    "the output": (EXPRESS, ROW["/output/gain"], 6.0),
    "a held value": (HOLD, ROW["/playing/vibrato"], 20.0),
    "silence": (STOP, 0, 1.0),
}


@pytest.mark.parametrize(
    ("role", "names"),
    [("own", list(WISHES)), ("play", list(WISHES)[:4]), ("listen", [])],
)
def test_each_role_may_wish_its_own(role, names) -> None:
    wishes = np.array([[-1.0, *wish, 0.0] for wish in WISHES.values()])
    found, ends = permitted(role, wishes)
    assert found.tolist() == [[-1.0, *WISHES[name], 0.0] for name in names]
    assert ends == (role == "play")


class View:
    """What a page sees of the instruments: nothing, but it keeps what is posted."""

    rate = 48_000.0

    def __init__(self) -> None:
        self.posted: list[int] = []

    def frame_of(self, arrived_ns: int) -> int:
        return arrived_ns // 20_000

    def taped(self) -> int:
        return 0

    def load(self) -> tuple[float, int]:
        return 0.0, 0

    def post(self, _rig: int, _frame: int, kind: int, *_: float, **__: float) -> bool:
        self.posted.append(kind)
        return True


def visit(role: str | None, *wishes: tuple[int, int, float]) -> tuple[list[int], int | None, str]:
    """Send wishes as a page of a role: what was posted, the close code, and the role told."""

    async def meet() -> tuple[list[int], int | None, str]:
        view, told = View(), ""
        sockets = PageSockets(view, [0], dict)
        app = web.Application()

        async def page(request: web.Request) -> web.StreamResponse:
            return await sockets.serve_page(request, role)

        async def sound(request: web.Request) -> web.StreamResponse:
            return await sockets.serve_listener(request, role)

        app.router.add_get("/socket", page)
        app.router.add_get("/sound", sound)
        async with TestClient(TestServer(app)) as client:
            if role is None:
                async with client.ws_connect("/sound") as listener:
                    assert (await listener.receive()).data == NO_PIN
            async with client.ws_connect("/socket") as socket:
                message = await socket.receive()
                if message.type is WSMsgType.TEXT:
                    told = message.json()["status"]["role"]
                    rows = [[-1.0, *wish, 0.0] for wish in wishes]
                    await socket.send_bytes(np.array(rows, "<f8").tobytes())
                    await asyncio.sleep(0.1)
                return list(view.posted), socket.close_code, told

    return asyncio.run(meet())


def test_who_has_no_role_is_sent_away() -> None:
    assert visit(None) == ([], NO_PIN, "")


def test_a_listener_plays_nothing() -> None:
    assert visit("listen", *WISHES.values()) == ([], None, "listen")


def test_a_players_silence_is_the_players_own() -> None:
    posted, _, told = visit("play", WISHES["a note"], WISHES["silence"])
    assert posted == [BEGIN, LEAVE]
    assert told == "play"
    posted, _, _ = visit("play", WISHES["silence"])
    assert posted == []


def test_an_owners_silence_is_for_all() -> None:
    assert RELEASE_ALL in visit("own", WISHES["silence"])[0]
