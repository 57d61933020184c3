"""Pages that a server serves: they see its instruments, hear them, and play them."""

import asyncio
import contextlib
import json
import os
import signal
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import aiohttp
import mido
import numpy as np
import pytest
from live.page.serving import HOST, start, stop
from midi_input import receive
from waiting import PATIENCE_S, until

from yehu_server.ahead.interpreter import snapshot_layout, snapshot_length
from yehu_server.core.player.commands import BEGIN, END, EXPRESS, HOLD, RAMP, WRITE
from yehu_server.core.player.parameter_indices import INDEX
from yehu_server.live import traffic_limits as limits
from yehu_server.live.options import PartOptions
from yehu_server.live.page.page_sockets import COMMANDS, NO_PART, NOW, SNAPSHOT, WRONG
from yehu_server.live.page.players import CHANNELS, LOWEST
from yehu_server.live.server import Server
from yehu_server.params.table import TABLE
from yehu_server.playing.options import PlayingOptions

PROCESSES = Path("/proc")
PRESSURE, VIBRATO = "/playing/pressure", "/playing/vibrato"
SIZE, PAN = "/room/size", "/room/pan"
IDENTITY = {"Accept-Encoding": "identity"}


@pytest.fixture(scope="module")
def said() -> list[str]:
    return []


@pytest.fixture(scope="module")
def server(said) -> Iterator[Server]:
    """A server of two parts, of which the second is a section of two."""
    section = PlayingOptions(start=(("/playing/section", 2.0),))
    server = start((PartOptions(), PartOptions(section)), say=said.append)
    yield server
    stop(server)


@pytest.fixture(autouse=True)
def _silent(server) -> None:
    """Every part begins as at the start: commands of pages come by another ring than resets."""
    for player in server.players:
        player.reset(frame=player.frame_of())
        frame, instrument = player.frame_of(), player.instrument
        posted = instrument.posted

        def is_done(instrument=instrument, posted=posted, frame=frame) -> bool:
            meters = instrument.meters()
            return meters["drained"] >= posted and meters["next_frame"] > frame

        until(is_done, "no reset")


def url(server: Server, path: str = "/") -> str:
    return f"http://{HOST}:{server.pages.port}{path}"


def sounds(server: Server, pitch: float) -> bool:
    """Whether a note sounds; the player may lean its pitch a little."""
    return server.player.pitch == pytest.approx(pitch, abs=0.6)


def command(
    kind: int, index: int = 0, value: float = 0.0, other: float = 0.0, at: float = NOW
) -> Any:
    return [at, kind, index, value, other]


def packed(*commands: Any) -> bytes:
    return np.array(commands, "<f8").tobytes()


class Page:
    """A page's WebSocket."""

    def __init__(self, socket: aiohttp.ClientWebSocketResponse) -> None:
        self.socket = socket
        self.status: dict[str, Any] = {}

    async def want(self, *, snapshots: bool = False, sounds: bool = False) -> None:
        await self.socket.send_str(json.dumps({"snapshots": snapshots, "sounds": sounds}))

    async def command(self, *commands: Any) -> None:
        await self.socket.send_bytes(packed(*commands))

    async def numbers(self) -> Any:
        """The next message of numbers."""
        while True:
            message = await self.socket.receive()
            if message.type is aiohttp.WSMsgType.BINARY:
                return np.frombuffer(message.data, "<f8")
            assert message.type is aiohttp.WSMsgType.TEXT, message

    async def snapshot(self, address: str, expected: Callable[[float], bool]) -> Any:
        """The first snapshot in which a parameter's value is as expected."""
        await self.want(snapshots=True)
        while True:
            kind, *snapshot = await self.numbers()
            assert kind == SNAPSHOT
            if expected(snapshot[snapshot_length() + INDEX[address]]):
                return snapshot

    async def end(self) -> tuple[int, str]:
        """The code and the reason with which the server closes the connection."""
        while (message := await self.socket.receive()).type is aiohttp.WSMsgType.TEXT:
            pass
        assert message.type is aiohttp.WSMsgType.CLOSE
        return message.data, message.extra

    async def value_of(self, key: str) -> Any:
        """The value in the next text that has the key."""
        while True:
            message = await self.socket.receive()
            if message.type is aiohttp.WSMsgType.TEXT and key in (text := json.loads(message.data)):
                return text[key]


def with_pages(server: Server, visit: Callable[..., Any], *parts: object) -> Any:
    """Call a coroutine function with pages that play some parts."""

    async def meet() -> Any:
        async with aiohttp.ClientSession() as session:
            sockets = [
                await session.ws_connect(url(server, f"/socket?part={part}")) for part in parts
            ]
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


def test_files_have_their_types_and_run_no_foreign_script_and_nothing_else_is_there(server):
    for path, content_type in [
        ("/", "text/html"),
        ("/main.js", "text/javascript"),
        ("/facts.js", "text/javascript"),
        ("/style/base.css", "text/css"),
        ("/icon.svg", "image/svg+xml"),
    ]:
        status, headers, body = get(server, path)
        assert status == 200, path
        assert headers["Content-Type"].startswith(content_type)
        assert "default-src 'none'" in headers["Content-Security-Policy"]
        assert "'unsafe-inline'" not in headers["Content-Security-Policy"]
        assert body
    absent = ["/../pyproject.toml", "/facts", "/web", "/main.js/"]
    assert [get(server, path)[0] for path in absent] == [404] * 4
    assert b'name="yehu-server"' in get(server, "/", **IDENTITY)[2]  # so the page knows of it


def test_a_file_is_compressed_for_whoever_reads_that_and_sent_again_only_if_it_changed(server):
    _, headers, plain = get(server, "/examples.js", **IDENTITY)
    _, how, small = get(server, "/examples.js", **{"Accept-Encoding": "gzip"})
    assert how["Content-Encoding"] == "gzip"
    assert len(small) < 0.5 * len(plain)
    status, _, body = get(server, "/examples.js", **{"If-None-Match": headers["ETag"]})
    assert (status, body) == (304, b"")


def test_pages_get_the_module_and_what_captures_begin_with_once_they_are_there(server) -> None:
    until(lambda: get(server, "/yehu.wasm")[0] == 200, "no module")
    assert get(server, "/yehu.wasm")[1]["Content-Type"] == "application/wasm"
    assert json.loads(get(server, "/captures/48000.json", **IDENTITY)[2])["rate"] == 48000


def test_foreign_pages_are_refused(server) -> None:
    assert get(server, "/", Origin="http://example.com")[0] == 403
    assert get(server, "/", Host="example.com")[0] == 403
    assert get(server, "/socket", Origin="http://example.com", Upgrade="websocket")[0] == 403


# ---------------------------------------------------------------- snapshots


def test_snapshots_come_sixty_times_a_second_to_pages_that_want_them(server) -> None:
    async def watch(page: Page, other: Page) -> Any:
        await page.want(snapshots=True)
        snapshots = [await page.numbers() for _ in range(62)][2:]
        with pytest.raises(TimeoutError):
            await asyncio.wait_for(other.numbers(), 0.2)
        return snapshots

    snapshots = with_pages(server, watch, 1, 1)
    length = 1 + snapshot_length() + 2 * len(TABLE)
    assert {(snapshot[0], len(snapshot)) for snapshot in snapshots} == {(SNAPSHOT, length)}
    frames = np.array([snapshot[1 + snapshot_layout()["frame"][0]] for snapshot in snapshots])
    assert (np.diff(frames) >= 0).all()
    assert 40 < 59 / ((frames[-1] - frames[0]) / server.instrument.rate) < 70


# ---------------------------------------------------------------- commands


def test_a_page_does_not_end_the_keys_of_others(server) -> None:
    message = mido.Message("note_on", note=72, velocity=90)
    receive(server.player, message, frame=server.player.frame_of(), port=0)

    async def play(page: Page) -> None:
        await page.command(command(BEGIN, 0, 72.0, 72.0), command(END, 0, 72.0, 0.0))
        await asyncio.to_thread(until, lambda: server.player.notes_played, "no note")

    with_pages(server, play, 1)
    time.sleep(0.1)
    assert sounds(server, 72.0)


def test_a_command_ahead_is_applied_at_its_frame(server) -> None:
    server.instrument.report_commands()
    server.instrument.applied_commands()

    async def lateness(page: Page, ahead: int) -> int:
        frame = server.instrument.frame + ahead
        await page.command(command(WRITE, INDEX[PRESSURE], 0.75, at=frame))
        await asyncio.to_thread(until, lambda: server.instrument.frame > frame + 480, "no time")
        applied = server.instrument.applied_commands()
        found = applied[(applied["kind"] == WRITE) & (applied["value"] == 0.75)]
        return int(found["frame"].item()) - frame

    async def play(page: Page) -> list[int]:
        found: list[int] = []
        for ahead in (12000, 48000, 192000):  # a busy machine may be late with the message itself
            found.append(await lateness(page, ahead))
            if found[-1] == 0:
                break
        return found

    assert with_pages(server, play, 1)[-1] == 0


def test_what_is_no_command_and_no_question_ends_the_connection(server, subtests) -> None:
    async def ending(page: Page, said: str | bytes) -> Any:
        await (page.socket.send_str if isinstance(said, str) else page.socket.send_bytes)(said)
        return (await page.end())[0]

    for said in [
        *("", "[]", "{}", '{"snapshots": 1}', "[" * 5000),
        packed(command(RAMP, 0, 1.0)),
        packed(command(11)),
        packed(command(-1)),
        packed(command(2.5)),
        packed(command(WRITE, 0, np.nan)),
        packed(command(WRITE, 0.5, 1.0)),
        packed(command(HOLD, len(TABLE), 1.0)),
        packed(command(EXPRESS, -1, 1.0)),
        packed(command(BEGIN, LOWEST - 1, 69.0, 69.0)),
        packed(command(BEGIN, LOWEST + CHANNELS, 69.0, 69.0)),
        packed(command(WRITE, 0, 1.0, at=-2)),
        packed(command(WRITE, 0, 1.0, at=1e300)),
        packed(command(WRITE))[:-1],
        b"",
    ]:
        with subtests.test(said=said[:40]):
            assert with_pages(server, lambda page, said=said: ending(page, said), 1) == WRONG


def test_a_message_may_hold_as_many_commands_as_the_limit_says_and_no_more(server) -> None:
    many = packed(command(WRITE, INDEX[PRESSURE], 0.4375)) * limits.PAGE_EVENTS
    server.instrument.report_commands()

    def is_applied() -> bool:
        return 0.4375 in server.instrument.applied_commands()["value"]

    async def play(page: Page) -> Any:
        await page.socket.send_bytes(many)
        await asyncio.to_thread(until, is_applied, "not taken")
        await page.socket.send_bytes(many + packed(command(WRITE, INDEX[PRESSURE], 0.5)))
        return (await page.end())[0]

    assert with_pages(server, play, 1) in {WRONG, aiohttp.WSCloseCode.MESSAGE_TOO_BIG}


def test_pages_that_sound_get_the_commands_of_others_and_hear_that_they_left(server) -> None:
    async def share(one: Page, other: Page) -> Any:
        number = (await one.value_of("status"))["page"]
        await other.want(sounds=True)
        await asyncio.sleep(0.2)
        await one.command(command(BEGIN, 0, 69.0, 69.0))
        found = await other.numbers()
        await one.socket.close()
        assert await other.value_of("left") == number
        return found.tolist(), number

    found, number = with_pages(server, share, 1, 1)
    assert found == [COMMANDS, number, *command(BEGIN, 0, 69.0, 69.0)]


# ---------------------------------------------------------------- parts


def test_the_status_says_which_part_it_is_and_one_that_is_not_there_ends_the_connection(server):
    for part in (1, 2):
        status = with_pages(server, lambda page: page.value_of("status"), part)
        assert (status["part"], status["parts"]) == (part, 2)
    for part in ("0", "3", "-1", "x", "", "1.0"):
        assert with_pages(server, Page.end, part) == (NO_PART, "there are 2 parts"), part


def test_a_page_plays_its_part_and_lets_go_of_it_as_it_leaves(server) -> None:
    first, second = server.players

    async def play(page: Page) -> None:
        await page.command(command(BEGIN, 3, 72.0, 72.0))
        await asyncio.to_thread(until, lambda: second.pitch is not None, "no note")
        assert len(second.held()) == 1

    with_pages(server, play, 2)
    assert first.pitch is None
    until(lambda: not second.held() and second.pitch is None, "it still sounds")


# ---------------------------------------------------------------- sound


def test_twenty_listeners_get_what_is_played_without_a_gap(server) -> None:
    server.player.key_on(69.0, 90.0, frame=server.player.frame_of())

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
        await page.command(command(BEGIN, 0, 69.0, 69.0))
        await asyncio.to_thread(until, lambda: sounds(server, 69.0), "no note")
        os.kill(process_of_pages(), signal.SIGKILL)
        await asyncio.to_thread(until, lambda: server.player.pitch is None, "it still sounds")

    with_pages(server, play, 1)
    assert get(server, "/")[0] == 200
    assert [line for line in said if line.startswith("pages: ")]
