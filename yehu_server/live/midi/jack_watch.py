"""Watch JACK for what RtMidi does not report: the server's end, and ports that disappear.

This is a JACK client of its own, without ports. When the server ends, it ends this process, since
nothing that RtMidi does after that is safe.
"""

from __future__ import annotations

import ctypes
import ctypes.util
import os
from typing import Any

NO_START_SERVER = 1
PORT_IS_GONE = 0


class JackWatch:
    """A JACK client that watches the running server."""

    def __init__(self, name: str) -> None:
        self._left: set[str] = set()
        self._client: int | None = None
        library = ctypes.util.find_library("jack")
        if library is None:
            return
        self._jack = jack = ctypes.CDLL(library)
        jack.jack_client_open.restype = ctypes.c_void_p
        jack.jack_port_by_id.restype = ctypes.c_void_p
        jack.jack_port_name.restype = ctypes.c_char_p
        self._client = jack.jack_client_open(name.encode(), NO_START_SERVER, None)
        if not self._client:
            return
        # Referenced here, since JACK keeps only their addresses.
        self._ended = ctypes.CFUNCTYPE(None, ctypes.c_void_p)(lambda _: os._exit(1))
        kind = ctypes.CFUNCTYPE(None, ctypes.c_uint32, ctypes.c_int, ctypes.c_void_p)
        self._registered = kind(self._port_changed)
        client = ctypes.c_void_p(self._client)
        jack.jack_on_shutdown(client, self._ended, None)
        jack.jack_set_port_registration_callback(client, self._registered, None)
        jack.jack_activate(client)

    def left(self) -> set[str]:
        """Full names of ports that disappeared since the last call, even if they are back."""
        left, self._left = self._left, set()
        return left

    def _port_changed(self, number: int, change: int, _argument: Any) -> None:
        if change == PORT_IS_GONE:
            port = self._jack.jack_port_by_id(ctypes.c_void_p(self._client), number)
            name = self._jack.jack_port_name(ctypes.c_void_p(port)) if port else None
            if name:
                self._left.add(name.decode(errors="replace"))
