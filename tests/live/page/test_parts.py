"""Pages that play several parts of one server."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Callable, Iterator
from typing import Any

import aiohttp
import numpy as np
import pytest
from waiting import PATIENCE_S, until

from yehu_server.ahead.interpreter import look_layout, look_length
from yehu_server.core.player.rows import ROW
from yehu_server.core.player.wishes import BEGIN, STOP, WRITE
from yehu_server.live.audio.output import OutputOptions
from yehu_server.live.options import PartOptions, ServeOptions
from yehu_server.live.page.pages import PageOptions
from yehu_server.live.page.sockets import LOOK, NO_PART, NOW
from yehu_server.live.server import Server
from yehu_server.playing.options import PlayingOptions

HOST = "127.0.0.1"
PRESSURE, SIZE, PAN = "/playing/pressure", "/room/size", "/room/pan"
SECTION = 3  # players of the second part


@pytest.fixture(scope="module")
def server() -> Iterator[Server]:
    """A server of two parts, of which the second is a section."""
    section = PlayingOptions(start=(("/playing/section", float(SECTION)),))
    options = ServeOptions(
        output=OutputOptions(device="null"),
        midi=None,
        osc=(HOST, 0),
        page=PageOptions((HOST, 0)),
        parts=[PartOptions(), PartOptions(section)],
    )
    server = Server(options)
    server.start()
    yield server
    server.skip_fade_out()
    server.stop()


@pytest.fixture(autouse=True)
def _silent(server) -> None:
    """Every part begins as at the start: what a page wishes comes by another ring than resets."""
    for player in server.players:
        player.reset(frame=player.frame_of())
        frame, instrument = player.frame_of(), player.instrument
        posted = instrument.posted

        def is_done(instrument=instrument, posted=posted, frame=frame) -> bool:
            meters = instrument.meters()
            return meters["drained"] >= posted and meters["next_frame"] > frame

        until(is_done, "no reset")


def visit(server: Server, part: object, act: Callable[..., Any]) -> Any:
    """Call a coroutine function with the WebSocket of a page that plays a part."""

    async def meet() -> Any:
        address = f"http://{HOST}:{server.pages.port}/socket?part={part}"
        async with (
            asyncio.timeout(PATIENCE_S),
            aiohttp.ClientSession() as session,
            session.ws_connect(address) as socket,
        ):
            return await act(socket)

    return asyncio.run(meet())


async def send(socket: Any, *wish: float) -> None:
    await socket.send_bytes(np.array([NOW, *wish, 0.0, 0.0][:5], "<f8").tobytes())


async def told(socket: Any, row: str, expected: Callable[[float], bool]) -> Any:
    """The first look in which a parameter's value is as expected."""
    await socket.send_str(json.dumps({"looks": True, "sounds": False}))
    while True:
        message = await socket.receive()
        if message.type is aiohttp.WSMsgType.BINARY:
            numbers = np.frombuffer(message.data, "<f8")
            assert numbers[0] == LOOK
            if expected(numbers[1 + look_length() + ROW[row]]):
                return numbers[1:]


def test_the_status_tells_which_part_it_is_and_how_many_there_are(server) -> None:
    async def ask(socket: Any) -> Any:
        return (await socket.receive_json())["status"]

    for part in (1, 2):
        status = visit(server, part, ask)
        assert (status["part"], status["parts"]) == (part, 2)


@pytest.mark.parametrize("part", ["0", "3", "-1", "x", "", "1.0"])
def test_a_part_that_is_not_there_closes_the_connection_and_says_so(server, part) -> None:
    async def ask(socket: Any) -> Any:
        message = await socket.receive()
        return message.type, socket.close_code, message.extra

    found = visit(server, part, ask)
    assert found == (aiohttp.WSMsgType.CLOSE, NO_PART, "there are 2 parts")


def test_a_page_plays_its_part_and_lets_go_of_it_as_it_leaves(server) -> None:
    first, second = server.players

    async def play(socket: Any) -> None:
        await send(socket, BEGIN, 0, 72.0, 72.0)
        await asyncio.to_thread(until, lambda: second.pitch is not None, "no note")

    visit(server, 2, play)
    assert first.pitch is None
    until(lambda: second.pitch is None, "it still sounds")


def test_silence_in_a_page_silences_its_part(server) -> None:
    for player in server.players:
        player.note_on(69.0, 90.0, frame=player.frame_of())
    until(lambda: all(player.pitch for player in server.players), "no notes")

    async def panic(socket: Any) -> None:
        await send(socket, STOP, 0, 1.0)
        await asyncio.to_thread(until, lambda: server.players[1].pitch is None, "still there")

    visit(server, 2, panic)
    assert server.players[0].pitch is not None


def test_a_look_is_at_the_parts_own_instrument(server) -> None:
    for player, value in zip(server.players, (0.25, 0.75), strict=True):
        player.write(PRESSURE, value, frame=player.frame_of())
    for part, value in ((1, 0.25), (2, 0.75)):
        visit(server, part, lambda socket, value=value: told(socket, PRESSURE, value.__eq__))


def test_the_room_is_one_for_all_whichever_page_sets_it(server) -> None:
    async def furnish(socket: Any) -> None:
        await send(socket, WRITE, ROW[SIZE], 12.0)
        await told(socket, SIZE, (12.0).__eq__)

    visit(server, 2, furnish)
    assert server.players[0].value(SIZE) == 12.0


def test_a_section_tells_the_parts_place_and_not_its_first_players(server) -> None:
    part = server.players[1]

    async def move(socket: Any) -> None:
        await told(socket, PAN, part.value(PAN).__eq__)
        await send(socket, WRITE, ROW[PAN], 0.25)
        await told(socket, PAN, (0.25).__eq__)

    visit(server, 2, move)
    until(lambda: part.value(PAN) == 0.25, "the pan")
    first = server.parts[1].instruments[0]
    assert first.target(PAN) != 0.25


def test_the_level_is_that_of_the_mix_in_every_part(server) -> None:
    server.players[0].note_on(69.0, 90.0, frame=server.players[0].frame_of())
    rms = look_layout()["rms"][0]

    async def listen(socket: Any) -> None:
        while (await told(socket, PAN, lambda _: True))[rms] < 1e-3:
            pass

    visit(server, 2, listen)
