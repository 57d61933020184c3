"""Pages that a server serves: they see its instrument, hear it, and play it."""

from __future__ import annotations

import asyncio
import contextlib
import json
import os
import signal
import socket
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import aiohttp
import mido
import numpy as np
import pytest
from midi_input import receive
from waiting import PATIENCE_S, until
from web_client import Refused, WebSocket

from yehu_server.ahead.interpreter import look_layout, look_length
from yehu_server.core.player.rows import ROW
from yehu_server.core.player.wishes import BEGIN, END, EXPRESS, HOLD, RAMP, STOP, WRITE
from yehu_server.live.audio.output import OutputOptions
from yehu_server.live.options import ServeOptions
from yehu_server.live.page.pages import PageOptions
from yehu_server.live.page.players import CHANNELS, LOWEST
from yehu_server.live.page.sockets import LOOK, NOW, WISHES, WRONG
from yehu_server.live.server import Server
from yehu_server.live.web.access import MOST_OF_A_HOST, MOST_SOCKETS_OF_A_HOST
from yehu_server.live.web.server import WebOptions
from yehu_server.params.table import TABLE

PROCESSES = Path("/proc")
HOST = "127.0.0.1"
PRESSURE = "/playing/pressure"
IDENTITY = {"Accept-Encoding": "identity"}


@pytest.fixture(scope="module")
def said() -> list[str]:
    return []


@pytest.fixture(scope="module")
def server(said) -> Iterator[Server]:
    options = ServeOptions(
        output=OutputOptions(device="null"),
        midi=None,
        osc=(HOST, 0),
        http=WebOptions((HOST, 0)),
        page=PageOptions((HOST, 0)),
    )
    server = Server(options, said.append)
    server.start()
    yield server
    server.skip_fade_out()
    server.stop()


@pytest.fixture(autouse=True)
def _silent(server) -> None:
    server.player.reset(frame=server.player.frame_of())


def url(server: Server, path: str = "/") -> str:
    return f"http://{HOST}:{server.pages.port}{path}"


def sounds(server: Server, pitch: float) -> bool:
    """Whether a note sounds; the player may lean its pitch a little."""
    return server.player.pitch == pytest.approx(pitch, abs=0.6)


def wish(kind: int, index: int = 0, value: float = 0.0, other: float = 0.0, at: float = NOW) -> Any:
    return [at, kind, index, value, other]


def packed(*wishes: Any) -> bytes:
    return np.array(wishes, "<f8").tobytes()


class Page:
    """A page's WebSocket."""

    def __init__(self, socket: aiohttp.ClientWebSocketResponse) -> None:
        self.socket = socket
        self.status: dict[str, Any] = {}

    async def want(self, *, looks: bool = False, sounds: bool = False) -> None:
        await self.socket.send_str(json.dumps({"looks": looks, "sounds": sounds}))

    async def wish(self, *wishes: Any) -> None:
        await self.socket.send_bytes(packed(*wishes))

    async def numbers(self) -> Any:
        """The next message of numbers."""
        while True:
            message = await self.socket.receive()
            if message.type is aiohttp.WSMsgType.BINARY:
                return np.frombuffer(message.data, "<f8")
            assert message.type is aiohttp.WSMsgType.TEXT, message

    async def told(self, key: str) -> Any:
        """What the next text that has it tells."""
        while True:
            message = await self.socket.receive()
            if message.type is aiohttp.WSMsgType.TEXT and key in (text := json.loads(message.data)):
                return text[key]


def with_pages(server: Server, count: int, visit: Callable[..., Any]) -> Any:
    """Call a coroutine function with some pages that are connected."""

    async def meet() -> Any:
        async with aiohttp.ClientSession() as session:
            sockets = [await session.ws_connect(url(server, "/socket")) for _ in range(count)]
            try:
                async with asyncio.timeout(2 * PATIENCE_S):
                    return await visit(*map(Page, sockets))
            finally:
                for socket in sockets:
                    await socket.close()

    return asyncio.run(meet())


def get(server: Server, path: str, **headers: str) -> Any:
    async def ask() -> Any:
        async with (
            aiohttp.ClientSession(auto_decompress=False) as session,
            session.get(url(server, path), headers=headers, allow_redirects=False) as answer,
        ):
            return answer.status, answer.headers, await answer.read()

    return asyncio.run(ask())


# ---------------------------------------------------------------- files


@pytest.mark.parametrize(
    ("path", "content_type"),
    [
        ("/", "text/html"),
        ("/main.js", "text/javascript"),
        ("/facts.js", "text/javascript"),
        ("/examples.js", "text/javascript"),
        ("/style/base.css", "text/css"),
        ("/icon.svg", "image/svg+xml"),
    ],
)
def test_files_have_their_types_and_run_no_foreign_script(server, path, content_type) -> None:
    status, headers, body = get(server, path)
    assert status == 200
    assert headers["Content-Type"].startswith(content_type)
    assert "default-src 'none'" in headers["Content-Security-Policy"]
    assert "'unsafe-inline'" not in headers["Content-Security-Policy"]
    assert body


def test_a_file_that_has_not_changed_is_not_sent_again(server) -> None:
    _, headers, _ = get(server, "/main.js")
    status, _, body = get(server, "/main.js", **{"If-None-Match": headers["ETag"]})
    assert (status, body) == (304, b"")


def test_texts_are_compressed_for_those_that_can_read_it(server) -> None:
    plain = get(server, "/examples.js", **IDENTITY)
    small = get(server, "/examples.js", **{"Accept-Encoding": "gzip"})
    assert small[1]["Content-Encoding"] == "gzip"
    assert len(small[2]) < 0.5 * len(plain[2])


def test_the_page_knows_that_it_has_a_server_by_its_first_file(server) -> None:
    assert b'name="yehu-server"' in get(server, "/", **IDENTITY)[2]


@pytest.mark.parametrize("path", ["/../pyproject.toml", "/facts", "/web", "/main.js/"])
def test_there_is_nothing_else(server, path) -> None:
    assert get(server, path)[0] == 404


def test_pages_get_the_module_and_what_captures_begin_with_once_they_are_there(server) -> None:
    until(lambda: get(server, "/yehu.wasm")[0] == 200, "no module")
    assert get(server, "/yehu.wasm")[1]["Content-Type"] == "application/wasm"
    assert json.loads(get(server, "/captures/48000.json", **IDENTITY)[2])["rate"] == 48000


def test_the_connections_of_a_host_shut_no_other_out(server) -> None:
    port = server.pages.port
    crowd = [socket.create_connection((HOST, port)) for _ in range(MOST_OF_A_HOST + 50)]
    try:
        for connection in crowd:
            with contextlib.suppress(OSError):  # the oldest were closed
                connection.sendall(b"GET / HTTP/1.1\r\nHo")  # half a request
        sockets = [
            WebSocket(port, "/sound", source="127.0.0.7") for _ in range(MOST_SOCKETS_OF_A_HOST)
        ]
        with pytest.raises(Refused):
            WebSocket(port, "/sound", source="127.0.0.7")
        WebSocket(port, "/sound", source="127.0.0.8").vanish()
        for one in sockets:
            one.vanish()
    finally:
        for connection in crowd:
            connection.close()


def test_foreign_pages_are_refused(server) -> None:
    assert get(server, "/", Origin="http://example.com")[0] == 403
    assert get(server, "/", Host="example.com")[0] == 403
    assert get(server, "/socket", Origin="http://example.com", Upgrade="websocket")[0] == 403


def test_oscquery_leads_to_the_page(server) -> None:
    async def ask() -> str:
        address = f"http://{HOST}:{server.web.port}/panel/"
        async with aiohttp.ClientSession() as session, session.get(address) as answer:
            assert answer.status == 200
            return str(answer.url)

    assert asyncio.run(ask()) == url(server)


# ---------------------------------------------------------------- looks


def test_looks_come_sixty_times_a_second_to_pages_that_want_them(server) -> None:
    async def watch(page: Page, other: Page) -> Any:
        await page.want(looks=True)
        looks = [await page.numbers() for _ in range(62)][2:]
        with pytest.raises(TimeoutError):
            await asyncio.wait_for(other.numbers(), 0.2)
        return looks

    looks = with_pages(server, 2, watch)
    assert {(look[0], len(look)) for look in looks} == {(LOOK, 1 + look_length() + 2 * len(TABLE))}
    frames = np.array([look[1 + look_layout()["frame"][0]] for look in looks])
    assert (np.diff(frames) >= 0).all()
    assert 40 < 59 / ((frames[-1] - frames[0]) / server.instrument.rate) < 70


def test_what_others_change_is_in_the_next_looks(server) -> None:
    async def watch(page: Page) -> float:
        await page.want(looks=True)
        server.player.write(PRESSURE, 0.625, frame=server.player.frame_of())
        for _ in range(60):
            look = await page.numbers()
            if look[1 + look_length() + ROW[PRESSURE]] == 0.625:
                return True
        return False

    assert with_pages(server, 1, watch)


# ---------------------------------------------------------------- wishes


def test_a_page_plays_and_lets_go_as_it_leaves(server) -> None:
    async def play(page: Page) -> None:
        await page.wish(wish(BEGIN, 3, 69.0, 69.0))
        await asyncio.to_thread(until, lambda: sounds(server, 69.0), "no note")
        assert len(server.player._wishes.held()) == 1

    with_pages(server, 1, play)
    until(lambda: not server.player._wishes.held(), "it is still held")
    until(lambda: server.player.pitch is None, "it still sounds")


def test_a_page_does_not_end_the_keys_of_others(server) -> None:
    message = mido.Message("note_on", note=72, velocity=90)
    receive(server.player, message, frame=server.player.frame_of(), port=0)

    async def play(page: Page) -> None:
        await page.wish(wish(BEGIN, 0, 72.0, 72.0), wish(END, 0, 72.0, 0.0))
        await asyncio.to_thread(until, lambda: server.player._wishes.notes_played, "no note")

    with_pages(server, 1, play)
    time.sleep(0.1)
    assert sounds(server, 72.0)


def test_parameters_and_panic_act_on_the_server(server) -> None:
    server.player.note_on(67.0, 90.0, frame=server.player.frame_of())

    async def play(page: Page) -> None:
        await page.wish(wish(WRITE, ROW[PRESSURE], 0.25))
        await asyncio.to_thread(until, lambda: server.player.value(PRESSURE) == 0.25, "not written")
        await page.wish(wish(STOP, 0, 1.0))
        await asyncio.to_thread(until, lambda: server.player.pitch is None, "no panic")

    with_pages(server, 1, play)


def test_a_wish_ahead_is_fulfilled_at_its_frame(server) -> None:
    server.instrument.report_wishes()
    server.instrument.applied_wishes()

    async def lateness(page: Page, ahead: int) -> int:
        frame = server.instrument.frame + ahead
        await page.wish(wish(WRITE, ROW[PRESSURE], 0.75, at=frame))
        await asyncio.to_thread(until, lambda: server.instrument.frame > frame + 480, "no time")
        applied = server.instrument.applied_wishes()
        found = applied[(applied["kind"] == WRITE) & (applied["value"] == 0.75)]
        return int(found["frame"].item()) - frame

    async def play(page: Page) -> list[int]:
        found: list[int] = []
        for ahead in (12000, 48000, 192000):  # a busy machine may be late with the message itself
            found.append(await lateness(page, ahead))
            if found[-1] == 0:
                break
        return found

    assert with_pages(server, 1, play)[-1] == 0


@pytest.mark.parametrize(
    "data",
    [
        packed(wish(RAMP, 0, 1.0)),
        packed(wish(11)),
        packed(wish(-1)),
        packed(wish(2.5)),
        packed(wish(WRITE, 0, np.nan)),
        packed(wish(WRITE, 0.5, 1.0)),
        packed(wish(HOLD, len(TABLE), 1.0)),
        packed(wish(EXPRESS, -1, 1.0)),
        packed(wish(BEGIN, LOWEST - 1, 69.0, 69.0)),
        packed(wish(BEGIN, LOWEST + CHANNELS, 69.0, 69.0)),
        packed(wish(WRITE, 0, 1.0, at=-2)),
        packed(wish(WRITE, 0, 1.0, at=1e300)),
        packed(wish(WRITE))[:-1],
        b"",
    ],
)
def test_what_is_no_wish_ends_the_connection(server, data) -> None:
    async def err(page: Page) -> Any:
        await page.socket.send_bytes(data)
        while (message := await page.socket.receive()).type is aiohttp.WSMsgType.TEXT:
            pass
        return message.data

    assert with_pages(server, 1, err) == WRONG


@pytest.mark.parametrize("text", ["", "[]", "{}", '{"looks": 1}', "[" * 5000])
def test_what_cannot_be_asked_ends_the_connection(server, text) -> None:
    async def err(page: Page) -> Any:
        await page.socket.send_str(text)
        while (message := await page.socket.receive()).type is aiohttp.WSMsgType.TEXT:
            pass
        return message.data

    assert with_pages(server, 1, err) == WRONG


def test_pages_that_sound_get_the_wishes_of_others_and_hear_that_they_left(server) -> None:
    async def share(one: Page, other: Page) -> Any:
        number = (await one.told("status"))["page"]
        await other.want(sounds=True)
        await asyncio.sleep(0.2)
        await one.wish(wish(BEGIN, 0, 69.0, 69.0))
        found = await other.numbers()
        await one.socket.close()
        assert await other.told("left") == number
        return found.tolist(), number

    found, number = with_pages(server, 2, share)
    assert found == [WISHES, number, *wish(BEGIN, 0, 69.0, 69.0)]


# ---------------------------------------------------------------- sound


def test_twenty_listeners_get_what_is_played_without_a_gap(server) -> None:
    server.player.note_on(69.0, 90.0, frame=server.player.frame_of())

    async def listen(session: aiohttp.ClientSession, seconds: float) -> tuple[int, Any]:
        async with session.ws_connect(url(server, "/sound"), max_msg_size=0) as socket:
            first, heard, pieces = None, 0, []
            while heard < seconds * server.instrument.rate:
                message = await asyncio.wait_for(socket.receive(), PATIENCE_S)
                (frame,) = np.frombuffer(message.data[:8], "<f8")
                samples = np.frombuffer(message.data[8:], "<f4").reshape(-1, 2)
                first = int(frame) if first is None else first
                assert frame == first + heard
                heard += len(samples)
                pieces.append(samples)
            return first, np.concatenate(pieces)

    async def all_listen() -> Any:
        async with aiohttp.ClientSession(connector=aiohttp.TCPConnector(limit=0)) as session:
            return await asyncio.gather(*(listen(session, 0.4) for _ in range(20)))

    found = asyncio.run(all_listen())
    assert len(found) == 20
    for first, samples in found:
        begin, taped = server.ensemble.taped(first)
        assert begin == first
        assert (samples == taped[: len(samples)]).all()
        assert np.abs(samples).max() > 1e-3


# ---------------------------------------------------------------- the process


def process_of_pages() -> int:
    """The number of the process that serves them: a child of ours."""
    for entry in PROCESSES.glob("[0-9]*"):
        with contextlib.suppress(OSError):
            parent = (entry / "stat").read_text().rpartition(")")[2].split()[1]
            if (
                parent == str(os.getpid())
                and "live.page.process" in (entry / "cmdline").read_text()
            ):
                return int(entry.name)
    raise LookupError("no process serves pages")  # a kill of 0 would end the tests


@pytest.mark.skipif(not PROCESSES.is_dir(), reason="finds the process there")
def test_a_process_that_dies_ends_its_pages_notes_and_is_replaced(server, said) -> None:
    async def play(page: Page) -> None:
        await page.wish(wish(BEGIN, 0, 69.0, 69.0))
        await asyncio.to_thread(until, lambda: sounds(server, 69.0), "no note")
        os.kill(process_of_pages(), signal.SIGKILL)
        await asyncio.to_thread(until, lambda: server.player.pitch is None, "it still sounds")

    with_pages(server, 1, play)
    assert get(server, "/")[0] == 200
    assert [line for line in said if line.startswith("pages: ")]
