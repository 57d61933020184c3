"""The process that serves pages: ``python -m yehu_server.live.page.process``.

It reads the instruments in shared memory, and posts commands there itself. So neither pictures nor
sound for twenty pages delay a note.
"""

import asyncio
import os
import threading
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

from aiohttp import web

from yehu_server.core.player.note_range import NoteRange
from yehu_server.live.network import Allowed
from yehu_server.live.page.guests import Admission, Guests
from yehu_server.live.page.page_sockets import PageSockets
from yehu_server.live.page.shared_view import SharedView
from yehu_server.live.page.site import HEADERS, Site
from yehu_server.live.web.request_filter import Connections, check, own_names, serve_http
from yehu_server.system.processes import LOWER, lower_priority
from yehu_server.system.sockets import shared
from yehu_server.util.processes import Child, Message, Parent

SOCKET, SOUND = "/socket", "/sound"
PREPARING, READY, NONE = "preparing", "ready", "none"


class Pages:
    """The site, the WebSockets, and what the control process sends them."""

    def __init__(self, order: Message) -> None:
        self._listening = shared(order["socket"])
        self._allowed = Allowed(order["allowed"])
        guests = order["guests"]
        self._admission = Admission(None if guests is None else Guests(**guests))
        self._names = own_names()
        self._connections = Connections()
        self._site = Site(NoteRange(tuple(order["open_notes"]), tuple(order["reaches"])))
        # What pages are sent of the server, and whether they can compute the sound themselves.
        self._status: dict[str, Any] = {"sounds": PREPARING}
        self._sockets = PageSockets(SharedView(order["memory"]), order["rigs"], self._status)
        # Windows' usual one ties the socket to its process: the next one could not accept.
        self._loop = asyncio.SelectorEventLoop()
        self._finder: Child | None = None

    def _prepare(self) -> None:
        """Find or compile the module for pages, once a page is opened."""

        def found(event: Message) -> None:
            self._loop.call_soon_threadsafe(self._found, event)

        if self._finder is None:
            self._finder = Child("yehu_server.live.page.module_process", found)

    def _found(self, event: Message) -> None:
        """Handle an event of the process that finds the module for pages."""
        if event["event"] == "module":
            self._site.add_module(Path(event["path"]).read_bytes())
            self._status["sounds"] = READY
        elif event["event"] == "beginning":
            self._site.add_capture_header(event["name"], event["text"])
        elif self._status["sounds"] == PREPARING:
            self._site.set_no_module(event.get("reason", "what prepares it has ended"))
            self._status["sounds"] = NONE

    def take_orders(self, orders: Iterator[Message]) -> None:
        """Take the state of the server as it is sent, until the control process ends."""
        for order in orders:
            self._loop.call_soon_threadsafe(self._status.update, order["status"])
            self._loop.call_soon_threadsafe(self._sockets.set_own_values, order["own"])
        if self._finder is not None:
            self._finder.kill()
        os._exit(0)

    def run(self) -> None:
        """Serve, for ever."""
        self._loop.run_until_complete(self._serve())

    async def _serve(self) -> None:
        await serve_http(self._answer, self._listening, self._connections)
        sockets = self._sockets
        await asyncio.gather(sockets.send_snapshots(), sockets.send_sound(), sockets.send_status())

    async def _answer(self, request: web.Request) -> web.StreamResponse:
        try:
            return await self._respond(request)
        except web.HTTPException as error:
            error.headers.update(HEADERS)
            raise

    async def _respond(self, request: web.Request) -> web.StreamResponse:
        check(request, self._allowed, self._names)
        self._prepare()
        serve = {SOCKET: self._sockets.serve_page, SOUND: self._sockets.serve_listener}
        if request.path not in serve:
            return self._site.answer(request)
        if request.headers.get("Upgrade", "").lower() != "websocket":
            raise web.HTTPUpgradeRequired(text="for WebSockets\n")
        with self._connections.web_socket(request):
            role = self._admission.role_of(request.remote or "", request.query.get("pin", ""))
            return await serve[request.path](request, role)


def main() -> None:
    """Serve the parent process until it closes the pipe."""
    parent = Parent()
    lower_priority(LOWER)
    orders = parent.orders()
    pages = Pages(next(orders))
    threading.Thread(target=partial(pages.take_orders, orders), daemon=True).start()
    parent.send("serving")
    pages.run()


if __name__ == "__main__":
    main()
