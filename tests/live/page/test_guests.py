"""Guests of a server in the local network: what each may do, and the PIN that lets them in."""

import asyncio
from types import SimpleNamespace

import numpy as np
import pytest
from aiohttp import WSMsgType, web
from aiohttp.test_utils import TestClient, TestServer
from wire import StillTime

from yehu_server.core.midi.events import LEAVE, RELEASE_ALL
from yehu_server.core.player.commands import (
    BEGIN,
    DRAW,
    EXPRESS,
    HOLD,
    KINDS,
    RELEASE,
    SLIDE,
    STOP,
    WRITE,
)
from yehu_server.core.player.parameter_indices import INDEX
from yehu_server.live import traffic_limits as limits
from yehu_server.live.page import guests as admitting
from yehu_server.live.page import page_sockets as serving
from yehu_server.live.page.guests import Admission, Guests
from yehu_server.live.page.page_sockets import NO_PIN, SETTINGS, PageSockets
from yehu_server.live.page.players import OWNER_ONLY, permitted
from yehu_server.params.table import TABLE

HOST, ELSEWHERE, HOME = "127.0.0.1", "192.0.2.7", "192.0.2.9"


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
    assert len(admission._tries) <= limits.PEERS


def test_however_many_machines_guess_few_guesses_are_looked_at(monkeypatch) -> None:
    clock = StillTime(1000.0)
    monkeypatch.setattr(admitting, "time", clock)
    admission = Admission(Guests("play", "123456"))
    assert admission.role_of(HOME, "123456") == "play"
    hosts = [f"198.51.{n // 250}.{n % 250}" for n in range(2 * limits.PEERS)]
    for host in hosts[: limits.PINS_OF_ALL_AT_ONCE]:
        assert admission.role_of(host, "000000") is None
    assert [host for host in hosts if admission.role_of(host, "123456")] == []
    assert admission.role_of(HOME, "123456") == "play"  # it knew the PIN before
    clock.now += 1.1 / limits.PINS_OF_ALL_A_SECOND
    assert admission.role_of(hosts[-1], "123456") == "play"


def test_the_guesses_of_a_host_are_counted_while_others_guess() -> None:
    admission = Admission(Guests("play", "123456"))
    for _ in range(limits.PINS_AT_ONCE):
        assert admission.role_of(ELSEWHERE, "000000") is None
    for number in range(limits.PEERS - 1):
        admission.role_of(f"198.51.{number // 256}.{number % 256}", "000000")
    assert admission._tries[ELSEWHERE].left(0.0) < 1.0


# ---------------------------------------------------------------- roles

COMMANDS = {
    "a note": (BEGIN, 1, 69.0),
    "its value": (EXPRESS, INDEX["/playing/pressure"], 0.4),
    "a controller": (WRITE, INDEX["/playing/vibrato"], 20.0),
    "a bow": (DRAW, 0, 0.2),
    "its release": (RELEASE, 0, 0.0),
    "the room": (WRITE, INDEX["/room/size"], 20.0),
    "the body": (WRITE, INDEX["/body/gain"], 1.0),
    "the output": (EXPRESS, INDEX["/output/gain"], 6.0),
    "a held value": (HOLD, INDEX["/playing/vibrato"], 20.0),
    "silence": (STOP, 0, 1.0),
}


@pytest.mark.parametrize(
    ("role", "names"),
    [
        ("own", [name for name in COMMANDS if name != "a held value"]),
        ("play", list(COMMANDS)[:5]),
        ("listen", []),
    ],
)
def test_each_role_may_command_its_own(role, names) -> None:
    commands = np.array([[-1.0, *command, 0.0] for command in COMMANDS.values()])
    found, ends = permitted(role, commands)
    assert found[:, :3].tolist() == [[-1.0, *COMMANDS[name][:2]] for name in names]
    assert ends == (role == "play")


def test_a_guest_changes_nothing_that_the_owner_holds() -> None:
    # Every kind of command, for every parameter where it names one, owned or not.
    may = {"write", "express", "begin", "end", "draw", "slide", "lift", "release"}
    owned = [INDEX["/bow/force"], INDEX["/finger/2/position"], INDEX["/playing/vibrato"]]
    wrong = []
    for kind, name in enumerate(KINDS[1:], 1):
        for held in ([], owned):
            for index in range(len(TABLE) if kind in SETTINGS else 1):
                found, _ = permitted("play", np.array([[-1.0, kind, index, 0.0, 0.0]]), held)
                is_owned = kind in SETTINGS and index in {*held, *OWNER_ONLY}
                is_owned |= bool(held) and kind in (DRAW, SLIDE)
                if (len(found) == 1) != (name in may and not is_owned):
                    wrong.append((name, TABLE[index].address, held))
    assert not wrong
    release, _ = permitted("play", np.array([[-1.0, RELEASE, 0.0, 0.0, 0.0]]))
    assert release[0, 3] == 1.0  # what is held stays so


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

    def post(self, _rig: int, _page: int, _frame: int, kind: int, *_: float) -> int:
        self.posted.append(kind)
        return len(self.posted)

    def taken(self, _rig: int) -> int:
        return len(self.posted)

    def room(self, _rig: int, _page: int) -> int:
        return 100

    def held(self, _rig: int) -> list[int]:
        return []


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


def test_a_page_that_commands_too_much_has_to_wait_and_so_has_one_whose_queue_is_full(monkeypatch):
    clock, waited, full = StillTime(1000.0), [], []

    async def wait(seconds: float) -> None:
        clock.now += seconds
        waited.append(seconds)
        full.clear()

    monkeypatch.setattr(limits, "PAGE_EVENTS_A_SECOND", 0.001)
    monkeypatch.setattr(limits, "PAGE_EVENTS_AT_ONCE", 3.0)
    monkeypatch.setattr(serving, "AT_ONCE", 2)
    monkeypatch.setattr(serving, "time", clock)
    monkeypatch.setattr(View, "room", lambda *_: 0 if full else 100)
    monkeypatch.setattr(serving, "asyncio", SimpleNamespace(**vars(asyncio) | {"sleep": wait}))
    assert visit("own", *[COMMANDS["a note"]] * 6, at_once=6)[0] == [BEGIN] * 6
    assert waited == pytest.approx([1000.0, 2000.0])
    waited.clear()
    full.append(True)
    assert visit("own", COMMANDS["a note"])[0] == [BEGIN]
    assert waited == [serving.ROOM_S]
