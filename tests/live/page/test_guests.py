"""Guests of a server in the local network: what each may do, and the PIN that lets them in."""

from __future__ import annotations

import asyncio
from types import SimpleNamespace

import numpy as np
import pytest
from aiohttp import WSMsgType, web
from aiohttp.test_utils import TestClient, TestServer
from wire import StillTime

from yehu_server.core.midi.events import LEAVE, RELEASE_ALL
from yehu_server.core.player.commands import BEGIN, DRAW, EXPRESS, HOLD, STOP, WRITE
from yehu_server.core.player.parameter_indices import INDEX
from yehu_server.live import limits
from yehu_server.live.page import guests as admitting
from yehu_server.live.page import sockets as serving
from yehu_server.live.page.guests import Admission, Guests
from yehu_server.live.page.players import permitted
from yehu_server.live.page.sockets import NO_PIN, PageSockets

HOST, ELSEWHERE = "127.0.0.1", "192.0.2.7"


# ---------------------------------------------------------------- the PIN


def test_another_machine_needs_the_pin_and_has_to_wait_if_it_guesses(monkeypatch) -> None:
    clock = StillTime(1000.0)
    monkeypatch.setattr(admitting, "time", clock)
    admission = Admission(Guests("play", "123456"))
    assert admission.role_of(HOST, "") == "own"
    wrong = ("", "123457", "\u0661" * 6)
    assert [admission.role_of(ELSEWHERE, pin) for pin in wrong] == [None] * 3
    assert admission.role_of(ELSEWHERE, "123456") == "play"
    for _ in range(limits.PINS_AT_ONCE - 2):
        assert admission.role_of(ELSEWHERE, "123456") == "play"
        assert admission.role_of(ELSEWHERE, "000000") is None
    assert admission.role_of(ELSEWHERE, "123456") is None
    assert admission.role_of("192.0.2.8", "123456") == "play"
    clock.now += limits.PIN_AGAIN_S + 0.1
    assert admission.role_of(ELSEWHERE, "123456") == "play"
    assert Admission(None).role_of(ELSEWHERE, "") == "own"  # without guests all may do all


def test_however_many_machines_guess_few_are_remembered() -> None:
    admission = Admission(Guests("play", "123456"))
    for number in range(2 * limits.PEERS):
        assert admission.role_of(f"198.51.{number // 256}.{number % 256}", "000000") is None
    assert len(admission._tries) <= limits.PEERS + 1


# ---------------------------------------------------------------- roles

COMMANDS = {
    "a note": (BEGIN, 1, 69.0),
    "its value": (EXPRESS, INDEX["/playing/pressure"], 0.4),
    "a controller": (WRITE, INDEX["/playing/vibrato"], 20.0),
    "a bow": (DRAW, 0, 0.2),
    "the room": (WRITE, INDEX["/room/size"], 20.0),
    "the body": (WRITE, INDEX["/body/gain"], 1.0),
    "the output": (EXPRESS, INDEX["/output/gain"], 6.0),
    "a held value": (HOLD, INDEX["/playing/vibrato"], 20.0),
    "silence": (STOP, 0, 1.0),
}


@pytest.mark.parametrize(
    ("role", "names"),
    [("own", list(COMMANDS)), ("play", list(COMMANDS)[:4]), ("listen", [])],
)
def test_each_role_may_command_its_own(role, names) -> None:
    commands = np.array([[-1.0, *command, 0.0] for command in COMMANDS.values()])
    found, ends = permitted(role, commands)
    assert found.tolist() == [[-1.0, *COMMANDS[name], 0.0] for name in names]
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


Command = tuple[int, int, float]


def visit(
    role: str | None, *commands: Command, at_once: int = 9
) -> tuple[list[int], int | None, str]:
    """Send commands as a page of a role: what was posted, the close code, and the role sent.

    `at_once`: commands of one message.
    """

    async def meet() -> tuple[list[int], int | None, str]:
        view, own_role = View(), ""
        sockets = PageSockets(view, [0], {})
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
                    own_role = message.json()["status"]["role"]
                    rows = [[-1.0, *command, 0.0] for command in commands]
                    for some in (rows[at : at + at_once] for at in range(0, len(rows), at_once)):
                        await socket.send_bytes(np.array(some, "<f8").tobytes())
                    await asyncio.sleep(0.1)
                return list(view.posted), socket.close_code, own_role

    return asyncio.run(meet())


def test_silence_is_a_players_own_an_owners_for_all_and_a_listener_or_a_stranger_plays_nothing():
    assert visit(None) == ([], NO_PIN, "")
    assert visit("listen", *COMMANDS.values()) == ([], None, "listen")
    assert visit("play", COMMANDS["a note"], COMMANDS["silence"]) == ([BEGIN, LEAVE], None, "play")
    assert visit("play", COMMANDS["silence"])[0] == []
    assert RELEASE_ALL in visit("own", COMMANDS["silence"])[0]


def test_a_page_that_commands_too_much_has_to_wait(monkeypatch):
    waited: list[float] = []

    async def wait(seconds: float) -> None:
        waited.append(seconds)

    monkeypatch.setattr(limits, "PAGE_EVENTS_A_SECOND", 0.001)
    monkeypatch.setattr(limits, "PAGE_EVENTS_AT_ONCE", 3.0)
    monkeypatch.setattr(serving, "asyncio", SimpleNamespace(**vars(asyncio) | {"sleep": wait}))
    assert visit("own", *[COMMANDS["a note"]] * 6, at_once=2)[0] == [BEGIN] * 6
    assert waited == pytest.approx([1000.0, 3000.0], rel=0.01)
