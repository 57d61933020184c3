"""The WebSockets of pages: they get snapshots, sound and each other's commands, and send commands.

Messages to a client that does not read are dropped; other clients are not delayed.

A message of numbers is a sequence of float64, little-endian. From a page it is commands, of COMMAND
numbers each. To a page its first number says what follows: SNAPSHOT or COMMANDS, or it comes from
the socket of sound: then it is one frame number, and float32 samples from there on, left and right
in turn. A page plays one part, which its address names: `/socket?part=2`; without, the first.
"""

import asyncio
import json
import struct
import time
from collections.abc import AsyncIterator, Mapping, Sequence
from typing import Any

import numpy as np
from aiohttp import WSMsgType, web

from yehu_server.core.engine.telemetry import TELEMETRY_S
from yehu_server.core.player.commands import EXPRESS, HOLD, KINDS, RAMP, WRITE
from yehu_server.live import traffic_limits as limits
from yehu_server.live.page.players import CHANNELS, LOWEST, PagePlayers, permitted
from yehu_server.live.page.shared_view import SharedView
from yehu_server.live.web.frames import TEXT, frame_of, messages, write
from yehu_server.params.table import TABLE
from yehu_server.system import clocks
from yehu_server.util.token_bucket import TokenBucket

SNAPSHOT, COMMANDS = 0.0, 1.0
COMMAND = 5  # numbers: frame or NOW, kind, index, value, other
NOW = -1.0
SETTINGS = (WRITE, HOLD, EXPRESS)  # their index is that of a parameter
SOUND_S, STATUS_S = 0.001, 1.0
AT_ONCE, ROOM_S = 16, 0.001  # commands posted in one go; between two looks for room
MESSAGE_BYTES = 8 * COMMAND * limits.PAGE_EVENTS
HEARTBEAT_S, CLOSING_S = 10.0, 0.3
# Close codes: against the rules; the PIN is missing or wrong; there is no such part.
WRONG, NO_PIN, NO_PART = 1008, 4401, 4404
# What the first listener is sent of the sound that was just played.
FIRST_FRAMES = 512


class Page:
    """A page that is connected, by its number, and the part it plays, counted from 0."""

    def __init__(self, number: int, part: int, role: str, transport: Any) -> None:
        self.number = number
        self.part = part
        self.role = role  # of ``page.guests``
        self.transport = transport
        self.snapshots = self.sounds = False  # whether it wants snapshots; whether it sounds itself
        self.bucket = TokenBucket(limits.PAGE_EVENTS_A_SECOND, limits.PAGE_EVENTS_AT_ONCE)


class PageSockets:
    """All WebSockets of pages.

    `rigs`: the instrument that shows each part.
    `status`: the state of the server, beside what is in the record, of JSON's types; read anew
    each time that it is sent.
    """

    def __init__(self, view: SharedView, rigs: Sequence[int], status: Mapping[str, Any]) -> None:
        self._view = view
        self._rigs = rigs
        self._players = PagePlayers(view, rigs)
        self._status = status
        self._pages: dict[web.WebSocketResponse, Page] = {}
        self._listeners: dict[web.WebSocketResponse, Any] = {}
        self._has_pages, self._has_listeners = asyncio.Event(), asyncio.Event()
        # Of each part, the values that it has where its instrument has others: in a section, whose
        # players have seats of their own.
        self._own: dict[int, dict[int, float]] = {}

    # -- serving one -------------------------------------------------------------------------

    async def serve_page(self, request: web.Request, role: str | None) -> web.WebSocketResponse:
        """Serve a page until it goes; one without a role is sent away."""
        part = self._part_of(request)
        socket = await _open(request)
        if role is None:
            await socket.close(code=NO_PIN, message=b"the PIN is missing or wrong")
            return socket
        if part is None:
            await socket.close(code=NO_PART, message=f"there are {len(self._rigs)} parts".encode())
            return socket
        taken = {page.number for page in self._pages.values()}
        number = next(number for number in range(limits.WEB_SOCKETS + 1) if number not in taken)
        page = Page(number, part, role, request.transport)
        self._pages[socket] = page
        self._has_pages.set()
        try:
            self._send_status(page)
            async for message in messages(socket):
                if message.type is WSMsgType.BINARY:
                    commands = read_commands(message.data)
                elif message.type is WSMsgType.TEXT and self._set_wanted(page, message.data):
                    continue
                else:
                    commands = None
                if commands is None:
                    await socket.close(code=WRONG)
                    break
                await self._pass_on(page, commands)
        finally:
            del self._pages[socket]
            if not self._pages:
                self._has_pages.clear()
            self._players.leave(page.number, clocks.monotonic_ns())
            text = frame_of(json.dumps({"left": page.number}).encode(), TEXT)
            for other in self._pages.values():
                write(other.transport, text, limits.PAGE_UNSENT)
        return socket

    async def serve_listener(self, request: web.Request, role: str | None) -> web.WebSocketResponse:
        """Send the sound to a page until it goes; one without a role is sent away."""
        socket = await _open(request)
        if role is None:
            await socket.close(code=NO_PIN, message=b"the PIN is missing or wrong")
            return socket
        self._listeners[socket] = request.transport
        self._has_listeners.set()
        try:
            async for _ in messages(socket):  # only its end matters
                pass
        finally:
            self._listeners.pop(socket, None)
            if not self._listeners:
                self._has_listeners.clear()
        return socket

    def _part_of(self, request: web.Request) -> int | None:
        """The part that an address names, counted from 0; None where there is none."""
        words = [str(part) for part in range(1, len(self._rigs) + 1)]
        word = request.query.get("part", "1")
        return words.index(word) if word in words else None

    def _set_wanted(self, page: Page, text: str) -> bool:
        """Note what a page wants to be sent; return whether the text is right."""
        try:
            asked = json.loads(text)
            page.snapshots, page.sounds = asked["snapshots"] is True, asked["sounds"] is True
        except (ValueError, KeyError, TypeError, RecursionError):
            return False
        return True

    async def _pass_on(self, page: Page, commands: Any) -> None:
        """Post commands, some at a time, so that others have their turn; a fast page waits."""
        arrived_ns = clocks.monotonic_ns()
        for begin in range(0, len(commands), AT_ONCE):
            some = commands[begin : begin + AT_ONCE]
            await self._wait(page, len(some))
            self._post(page, some, arrived_ns)

    def _post(self, page: Page, commands: Any, arrived_ns: int) -> None:
        """Post what a page may command, and send it to other pages of its part that sound."""
        held = self._view.held(self._rigs[page.part])
        commands, ends = permitted(page.role, commands, held)
        self._players.post(page.number, page.part, commands, arrived_ns)
        if ends:
            self._players.leave(page.number, clocks.monotonic_ns())
        own = self._own.get(page.part, {})
        for _, kind, index, value, _ in commands:
            if kind == WRITE and index in own:
                own[int(index)] = value  # at once: the control process sends it later
        frame = frame_of(struct.pack("<2d", COMMANDS, page.number) + commands.tobytes())
        for other in self._pages.values():
            if len(commands) and other is not page and other.sounds and other.part == page.part:
                write(other.transport, frame, limits.PAGE_UNSENT)

    async def _wait(self, page: Page, commands: int) -> None:
        """Wait until a page may post more commands, also where they will be refused."""
        page.bucket.resize(max(AT_ONCE, limits.PAGE_EVENTS_AT_ONCE / len(self._pages)))
        page.bucket.spend(commands)
        while not page.transport.is_closing():
            left = page.bucket.left(time.monotonic())
            if left >= 0.0 and self._players.has_room(page.number, page.part, commands):
                return
            await asyncio.sleep(max(ROOM_S, -left / limits.PAGE_EVENTS_A_SECOND))

    # -- sending to all ----------------------------------------------------------------------

    def set_own_values(self, own: Sequence[Sequence[Sequence[float]]]) -> None:
        """Take values, by indices, that parts have where their instruments have others."""
        self._own = {
            part: {int(index): value for index, value in of} for part, of in enumerate(own)
        }

    async def send_snapshots(self) -> None:
        """Send snapshots, for ever."""
        async for _ in every(TELEMETRY_S, self._has_pages):
            viewers = [page for page in self._pages.values() if page.snapshots]
            for part in {page.part for page in viewers}:
                snapshot = self._view.snapshot(self._rigs[part], self._own.get(part, {}))
                frame = frame_of(struct.pack("<d", SNAPSHOT) + snapshot)
                for page in viewers:
                    if page.part == part:
                        write(page.transport, frame, limits.PAGE_UNSENT)

    async def send_sound(self) -> None:
        """Send the sound, for ever."""
        sent = 0
        while True:
            if not self._listeners:
                await self._has_listeners.wait()
                sent = self._view.taped() - FIRST_FRAMES
            end = self._view.taped()
            if end > sent:
                begin, samples = self._view.sound(max(sent, 0), end)
                frame = frame_of(struct.pack("<d", begin) + samples)
                for transport in self._listeners.values():
                    write(transport, frame, limits.PAGE_UNSENT)
            sent = end
            await asyncio.sleep(SOUND_S)

    async def send_status(self) -> None:
        """Send the status, for ever."""
        async for _ in every(STATUS_S, self._has_pages):
            for page in self._pages.values():
                self._send_status(page)

    def _send_status(self, page: Page) -> None:
        load, dropouts = self._view.load()
        status = {
            "page": page.number,
            "pages": len(self._pages),
            "role": page.role,
            "part": page.part + 1,
            "parts": len(self._rigs),
            "rate": self._view.rate,
            "frame": self._view.taped(),
            "load": load,
            "dropouts": dropouts,
            **self._status,
        }
        text = json.dumps({"status": status}, allow_nan=False)
        write(page.transport, frame_of(text.encode(), TEXT), limits.PAGE_UNSENT)


def read_commands(data: bytes) -> Any:
    """The commands of a message, in rows of COMMAND numbers; None where one is wrong."""
    if not data or len(data) % (8 * COMMAND) or len(data) > MESSAGE_BYTES:
        return None
    commands = np.frombuffer(data, "<f8").reshape(-1, COMMAND)
    frames, kinds, indices = commands[:, 0], commands[:, 1], commands[:, 2]
    is_right = (
        np.isfinite(commands).all()
        and (frames >= NOW).all()
        and ((kinds > RAMP) & (kinds < len(KINDS))).all()
        and (commands[:, :3] == np.rint(commands[:, :3])).all()
        and (np.where(np.isin(kinds, SETTINGS), indices, 0) < len(TABLE)).all()
        and (np.where(np.isin(kinds, SETTINGS), indices, 0) >= 0).all()
        and (indices >= LOWEST).all()
        and (indices < LOWEST + CHANNELS).all()
        and (frames < 1 << 53).all()
    )
    return commands if is_right else None


async def every(period_s: float, is_wanted: asyncio.Event) -> AsyncIterator[None]:
    """Yield periodically while an event is set; periods that were missed are left out."""
    due = time.monotonic()
    while await is_wanted.wait():
        yield
        due = max(due + period_s, time.monotonic())
        await asyncio.sleep(due - time.monotonic())


async def _open(request: web.Request) -> web.WebSocketResponse:
    socket = web.WebSocketResponse(
        timeout=CLOSING_S,
        heartbeat=HEARTBEAT_S,
        autoping=False,
        max_msg_size=MESSAGE_BYTES + 1,
        compress=False,
    )
    await socket.prepare(request)
    return socket
