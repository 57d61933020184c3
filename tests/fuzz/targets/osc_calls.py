"""OSC messages to the whole handler, on an instrument that only listens."""

import functools
import math
import os
import shutil
import struct
from collections.abc import Iterator
from contextlib import contextmanager
from unittest.mock import patch

from fuzz.instrument import Instrument, check_silence, check_values
from fuzz.target import Program, scratch, target
from wire import SINCE_1900_S, FakePeer, StillTime

from yehu_server.live.osc import clients
from yehu_server.live.osc.all_calls import CALLS
from yehu_server.live.osc.context import CallContext
from yehu_server.live.osc.handler import OscHandler
from yehu_server.live.osc.packets import pack, unpack
from yehu_server.live.part_addresses import part_of
from yehu_server.params.table import PREFIX, TABLE, UNIT
from yehu_server.playing.mapping import load
from yehu_server.playing.options import PlayingOptions
from yehu_server.playing.parts import player_of
from yehu_server.playing.player import Player
from yehu_server.playing.preset_folders import Presets
from yehu_server.system import clocks

MAX_PACKETS = 200
ADDRESSES = [
    *("/yehu/*", "/yehu/*/*", "/yehu/bow/[a-z", "/*/note", "/", "/yehu/{,}", "/my/fader"),
    "/yehu/subscribed",  # as another server says
    *(PREFIX + call.address for call in CALLS),
    *(PREFIX + param.address + form for param in TABLE for form in ("", UNIT)),
]
NAMES = ["", "/bow/force", "/playing/dynamics", "/*/*", "/[", "../x", "mine", "vibrato", "é" * 9]


def tree_changed(path: str) -> None:
    assert path.startswith("/")


def states(group: str) -> dict[str, float | str]:
    if group:
        return {"note": -1.0, "keys": float(part_of(group))}
    return {"load": 0.5, "recording": ""}


def context_of(player: Player, lines: list[str]) -> CallContext:
    """What the handler needs of a server."""
    return CallContext(
        [player],
        states,
        lambda name: f"{name}.wav",
        lambda: "take.wav",
        lines.append,
        lambda action: action(),
        lambda action: action(),
        [tree_changed],
    )


@contextmanager
def still_time() -> Iterator[StillTime]:
    """A manual clock, and no user settings, within the block."""
    clock = StillTime(1000.0)
    home = scratch() / "config"
    shutil.rmtree(home, ignore_errors=True)
    with (
        patch.object(clients, "time", clock),
        patch.object(clocks, "monotonic_ns", clock.monotonic_ns),
        patch.object(clocks, "now_s", clock.time),
        patch.dict(os.environ, XDG_CONFIG_HOME=str(home)),
    ):
        yield clock


@functools.cache
def mapping():
    return load("keyboard-expressive")


def tick(handler: OscHandler) -> None:
    """Do what is due."""
    for steps, _peer, _size in handler.due():
        for _ in steps:
            pass
    handler.clients.flush()


def argument(program: Program) -> tuple[str, bytes]:
    """A type tag, and the argument's bytes."""
    kind = program.byte()
    if kind < 128:  # mostly a number that means something
        return "f", struct.pack(">f", kind + program.byte() / 256.0)
    tag = "fidhTFNItrbsSc[]m"[kind % 17]
    if tag in "fitcrm":
        return tag, program.full(4 if tag != "t" else 8)
    if tag in "dh":
        return tag, program.full(8)
    if tag == "b":
        blob = program.take(program.byte())
        return tag, struct.pack(">i", len(blob)) + blob + b"\0" * (-len(blob) % 4)
    if tag in "sS":
        choice = program.byte()
        name = NAMES[choice].encode() if choice < len(NAMES) else program.take(choice % 16)
        name = name.replace(b"\0", b"")
        return tag, name + b"\0" * (4 - len(name) % 4)
    return tag, b""


def packet(program: Program, now_s: float, depth: int = 3) -> bytes:
    """The next packet of a program."""
    kind = program.byte()
    if kind < 16:
        return program.take(program.byte())
    if kind < 48 and depth:
        due_s = now_s + (program.byte() - 64) * 1e-3
        tag = round((due_s + SINCE_1900_S) * 2**32) if kind < 40 else 1
        inner = [packet(program, now_s, depth - 1) for _ in range(kind % 4)]
        sized = (struct.pack(">i", len(one)) + one for one in inner)
        return b"#bundle\0" + struct.pack(">Q", tag) + b"".join(sized)
    number = program.byte() | program.byte() << 8
    address = ADDRESSES[number % len(ADDRESSES)].encode()
    tagged = [argument(program) for _ in range(kind % 4)]
    tags = "," + "".join(tag for tag, _ in tagged)
    head = address + b"\0" * (4 - len(address) % 4) + tags.encode() + b"\0" * (4 - len(tags) % 4)
    return head + b"".join(data for _, data in tagged)


@target("osc-calls")
def osc_calls(data: bytes) -> None:
    """Any message is acted on or answered, no value leaves its range, and a panic ends every note.

    The bytes are a program: packets of addresses and arguments, and pauses between them.
    """
    with still_time() as clock:
        instrument, peer = Instrument(), FakePeer(host="peer")
        lines: list[str] = []
        playing = PlayingOptions(
            mapping=mapping(), presets=Presets(scratch() / "config" / "presets")
        )
        player = player_of(0, playing, [instrument], delay_ms=3.0)
        handler = OscHandler(context_of(player, lines))

        def take(what: bytes) -> None:
            for _ in handler.handle(what, peer, clock.monotonic_ns()):
                pass
            tick(handler)

        program = Program(data)
        for _ in range(MAX_PACKETS):
            if not program:
                break
            take(packet(program, clock.time()))
            pause_s = 1e-3 * (program.byte() % 64)
            clock.now += pause_s
            instrument.now_s += pause_s
            tick(handler)
        check_values(player)
        take(pack("/yehu/panic"))
        clock.now += 1.0
        check_silence(player, instrument)
        tick(handler)
        assert handler.waiting == 0
    for answer in (
        *peer.packets,
        *(one for other in peer.others.values() for one in other.packets),
    ):
        for message in unpack(answer):
            assert message.address.startswith(PREFIX)
            numbers = (value for value in message.arguments if isinstance(value, float))
            assert all(math.isfinite(value) for value in numbers) or message.address.endswith(
                "/pong"
            )
    assert not any("\n" in line for line in lines)
