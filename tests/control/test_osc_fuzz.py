"""Whatever comes in, the server goes on, leaves no note behind, and does not grow."""

from __future__ import annotations

import contextlib
import math
import os
import random
import struct
import time
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from yehu_server.params.table import TABLE

PAGE = os.sysconf("SC_PAGE_SIZE") if hasattr(os, "sysconf") else 4096
GROWTH_BYTES = 64 << 20

PARAMS = ["/yehu" + param.address for param in TABLE]
PLAYING = [
    f"/yehu{call}"
    for call in ("/note", "/note/off", "/pitch", "/bend", "/press", "/bow", "/release", "/panic")
]
ASKING = [
    f"/yehu{call}"
    for call in ("/reset", "/get", "/params", "/status", "/subscribe", "/unsubscribe", "/ping")
]
ODD = ["/yehu/*", "/yehu/*/*", "/yehu/bow/[a-z", "/*/note", "/", "/yehu/record/start", "/yehu/{,}"]

floats = st.floats(width=32) | st.sampled_from([0.0, -0.0, 1.0, 67.0, 90.0, 127.0, math.nan])
arguments = st.one_of(
    floats.map(lambda v: ("f", v)),
    st.floats().map(lambda v: ("d", v)),
    st.integers(-(2**31), 2**31 - 1).map(lambda v: ("i", v)),
    st.integers(-(2**63), 2**63 - 1).map(lambda v: ("h", v)),
    st.sampled_from([("T", True), ("F", False), ("N", None), ("I", None)]),
    st.integers(0, 2**64 - 1).map(lambda v: ("t", v)),
    st.integers(0, 2**32 - 1).map(lambda v: ("r", v)),
    st.binary(max_size=20).map(lambda v: ("b", v)),
    st.sampled_from(["", "/bow/force", "/*/*", "/[", "../x", "é" * 9]).map(lambda v: ("s", v)),
)
messages = st.tuples(
    st.sampled_from(PARAMS + PLAYING * 3 + ASKING + ODD), st.lists(arguments, max_size=3)
)
bundles = st.recursive(
    messages.map(lambda message: ("message", *message)),
    lambda inner: st.tuples(st.just("bundle"), st.floats(-1.0, 0.05), st.lists(inner, max_size=4)),
    max_leaves=8,
)
patient = settings(
    max_examples=150, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large]
)


def encoded(wire, thing, now_s: float) -> bytes:
    if thing[0] == "bundle":
        _, in_s, inner = thing
        return wire.bundle(now_s + in_s, *(encoded(wire, each, now_s) for each in inner))
    _, address, tagged = thing
    values = [value for tag, value in tagged if tag != "I"]
    return wire.message(address, *values, tags="".join(tag for tag, _ in tagged))


# ---------------------------------------------------------------- on the stage: any exception shows


@patient
@given(things=st.lists(bundles, max_size=12))
def test_any_messages_are_acted_on_or_answered_and_a_panic_ends_all(wire, fuzz_stage, things):
    stage = fuzz_stage
    for thing in things:
        stage.take(encoded(wire, thing, stage.clock.time()))
        stage.pass_time(0.003)
    stage.tell("/panic")
    stage.pass_time(0.05)
    assert stage.player.pitch is None
    assert stage.handler.waiting == 0
    stage.ear.packets.clear()
    stage.ear.others.clear()


@patient
@given(values=st.lists(st.tuples(st.sampled_from(PARAMS), arguments), max_size=30))
def test_every_value_stays_a_finite_number_within_its_bounds(wire, fuzz_stage, values):
    stage = fuzz_stage
    for address, (tag, value) in values:
        stage.take(wire.message(address, *([value] if tag != "I" else []), tags=tag))
    for param in TABLE:
        assert param.lo <= stage.player.value(param.address) <= param.hi
    stage.pass_time(0.01)
    for _, _, target in stage.events:
        assert math.isfinite(target)
    stage.events.clear()
    stage.tell("/reset")
    stage.pass_time(0.01)


# ---------------------------------------------------------------- over the wire


def garbage(wire, chance: random.Random, now_s: float) -> bytes:
    """Something that may be a packet."""
    kind = chance.randrange(8)
    address = chance.choice(PARAMS + PLAYING + ASKING + ODD)
    if kind == 0:
        return chance.randbytes(chance.randrange(200))
    if kind == 1:
        return b"/" + chance.randbytes(chance.randrange(100))
    if kind == 2:
        return wire.message(
            address, *(chance.uniform(-200.0, 200.0) for _ in range(chance.randrange(4)))
        )
    if kind == 3:
        return wire.message(
            address, chance.choice(["x" * 1000, None, b"\0" * 5000, math.nan, 2**40])
        )
    if kind == 4:
        deep = wire.message("/yehu/note", chance.uniform(60, 90), 90.0)
        for _ in range(chance.randrange(40)):
            deep = wire.bundle(now_s + chance.uniform(-0.1, 0.1), deep)
        return deep
    packet = bytearray(wire.bundle(now_s, wire.message(address, 67.0, 90.0)))
    if kind == 5:
        packet[chance.randrange(len(packet))] = chance.randrange(256)
    elif kind == 6:
        del packet[chance.randrange(len(packet)) :]
    else:
        packet = bytearray(wire.message(address, b"\xff" * chance.choice([60_000, 20_000, 0])))
    return bytes(packet)


def resident_bytes() -> int:
    return int(Path("/proc/self/statm").read_text().split()[1]) * PAGE


@pytest.mark.parametrize("kind", ["udp", "prefixed", "slip"])
def test_garbage_over_the_wire_neither_ends_nor_fills_the_server(hall, wire, kind):
    chance = random.Random(f"garbage by {kind}")
    sender = hall.client() if kind == "udp" else hall.stream(slip=kind == "slip")
    listener = hall.client()
    sizes = []
    for _ in range(4):
        for number in range(300):
            sender.take(garbage(wire, chance, time.time()))
            if number % 50 == 49:
                with contextlib.suppress(AssertionError):
                    sender.all(0.001)
        listener.sync()
        if Path("/proc/self/statm").exists():
            sizes.append(resident_bytes())
    time.sleep(0.15)  # the last bundles' time comes
    listener.tell("/panic")
    listener.sync()
    hall.settle()
    assert hall.is_at_rest()
    assert hall.is_well()
    assert hall.level() < 1e-6
    assert not sizes or sizes[-1] - sizes[0] < GROWTH_BYTES
    listener.tell("/reset")  # whatever was set
    listener.tell("/note", 67, 90)
    listener.sync()
    assert hall.player.pitch == pytest.approx(67.0, abs=0.5)


@pytest.mark.parametrize(
    "stream",
    [
        b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n",
        b"\xff" * 100_000,
        b"\0" * 100_000,
        b"\xc0" * 100_000,
        b"\xdb" * 100_000,
        struct.pack(">I", 2**31) + b"x" * 1000,
        struct.pack(">I", 2**20) + b"x" * 1000,
        b"\xc0/yehu/note",
    ],
    ids=["http", "ones", "zeros", "ends", "escapes", "huge", "long", "half"],
)
def test_a_stream_of_anything_else_is_survived(house, stream):
    bad, good = house.stream(), house.client()
    with contextlib.suppress(OSError):
        bad.socket.sendall(stream)
        bad.socket.shutdown(1)
    good.sync()
    good.tell("/note", 67, 90)
    good.sync()
    assert house.player.pitch == pytest.approx(67.0, abs=0.5)
    good.tell("/panic")
    assert bad.has_ended()
    assert house.is_well()
