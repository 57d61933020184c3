"""Parsing packets: every type, nested bundles, and damaged data."""

import itertools
import math
import struct
import tracemalloc

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from yehu_server.live import traffic_limits as limits
from yehu_server.live.osc.packets import Message, PacketError, steps, unpack

words = st.text(st.characters(exclude_characters="\0", exclude_categories=["Cs"]), max_size=12)
arguments = st.one_of(
    st.integers(-(2**31), 2**31 - 1).map(lambda v: ("i", v)),
    st.integers(-(2**63), 2**63 - 1).map(lambda v: ("h", v)),
    st.floats(width=32).map(lambda v: ("f", v)),
    st.floats().map(lambda v: ("d", v)),
    words.map(lambda v: ("s", v)),
    st.binary(max_size=12).map(lambda v: ("b", v)),
    st.sampled_from([("T", True), ("F", False), ("N", None)]),
)
messages = st.tuples(words.map("/".__add__), st.lists(arguments, max_size=6))


def same(one: object, other: object) -> bool:
    if isinstance(one, float) and isinstance(other, float) and math.isnan(one):
        return math.isnan(other)
    return type(one) is type(other) and one == other


# ---------------------------------------------------------------- what is whole


@given(messages)
@example(("/", [("s", ""), ("b", b""), ("d", 1e300), ("f", math.inf), ("i", -(2**31))]))
def test_every_type_of_argument_is_read_as_it_was_written(wire, message):
    address, tagged = message
    tags, values = "".join(tag for tag, _ in tagged), [value for _, value in tagged]
    (got,) = unpack(wire.message(address, *values, tags=tags))
    assert (got.address, got.due_s) == (address, None)
    assert len(got.arguments) == len(values)
    assert all(map(same, got.arguments, values))


def test_a_message_without_type_tags_has_no_arguments_and_at_once_is_no_time(wire):
    for packet in (wire.text("/a"), wire.message("/a"), wire.bundle(None, wire.message("/a"))):
        assert unpack(packet) == [Message("/a", [])]


def test_arguments_in_brackets_are_one_list():
    (got,) = unpack(b"/a\0\0,i[i[i]]\0\0\0\0" + struct.pack(">iii", 1, 2, 3))
    assert got.arguments == [1, [2, [3]]]


@given(st.floats(1.0, 2e9))
def test_a_time_tag_is_read_to_the_microsecond(wire, at_s):
    (got,) = unpack(wire.bundle(at_s, wire.message("/a")))
    assert got.due_s == pytest.approx(at_s, abs=1e-6)


def test_messages_of_bundles_keep_their_order_and_the_innermost_time(wire):
    inner = wire.bundle(3e8, wire.message("/b"), wire.bundle(None, wire.message("/c")))
    outer = wire.bundle(2e8, wire.message("/a"), inner, wire.message("/d"))
    assert [(m.address, m.due_s) for m in unpack(outer)] == [
        ("/a", 2e8),
        ("/b", 3e8),
        ("/c", 3e8),
        ("/d", 2e8),
    ]


def test_bundles_go_as_deep_in_bundles_as_is_allowed_and_no_deeper(wire):
    packet = wire.message("/a")
    for _ in range(limits.NESTING):
        packet = wire.bundle(None, packet)
    assert [m.address for m in unpack(packet)] == ["/a"]
    with pytest.raises(PacketError, match="deep"):
        unpack(wire.bundle(None, packet))


# ---------------------------------------------------------------- what is not


def test_what_is_no_packet_is_refused_and_of_a_bundle_nothing_counts(wire, subtests):
    whole, bundle = wire.message("/a"), wire.bundle(None)
    for packet in [
        b"",
        b"\0",
        b"\0\0\0\0",
        b"abc\0",
        b"yehu/panic\0\0",
        b"/yehu/panic",  # its end is missing
        b"/yehu/panic,\0\0\0",
        b"/a\0\0i\0\0\0\0\0\0\1",  # no comma
        b"/a\0\0,i\0\0",
        b"/a\0\0,i\0\0\0\0",
        b"/a\0\0,d\0\0\0\0\0\0",
        b"/a\0\0,s\0\0abcd",
        b"/a\0\0,b\0\0\0\0\0\x08abcd",
        b"/a\0\0,b\0\0\xff\xff\xff\xff",  # a blob of less than nothing
        b"/a\0\0,[i\0\0\0\0\1",
        b"/a\0\0,i]\0\0\0\0\1",
        b"/\xff\xff\0",
        b"/a\0\0,s\0\0\xff\xff\xff\0",
        b"#bundle",
        b"#bundle\0",
        b"#bundle\0\0\0\0\0",
        b"#bundlf\0" + b"\0" * 7 + b"\1",
        wire.message("/a", 0.7, tags="Xf"),  # a type that is not known
        bundle + b"\0\0",
        bundle + struct.pack(">i", -4) + whole,
        bundle + struct.pack(">i", 64) + whole,
        wire.bundle(None, whole, b"/b\0\0,i\0\0"),
        *(wire.bundle(None, whole, part) for part in (b"", b"\0\0\0\0", b"abcd", b"#bundl\0\0")),
        wire.bundle(None, whole, b",i\0\0\0\0\0\1"),
    ]:
        with subtests.test(packet=packet), pytest.raises(PacketError):
            unpack(packet)


@given(messages, st.data())
def test_a_message_that_is_cut_short_is_never_taken_for_another(wire, message, data):
    address, tagged = message
    tags, values = "".join(tag for tag, _ in tagged), [value for _, value in tagged]
    packet = wire.message(address, *values, tags=tags)
    cut = data.draw(st.integers(0, len(packet) - 1))
    try:
        (got,) = unpack(packet[:cut])
    except PacketError:
        return
    if cut == len(wire.text(address)):  # before the type tags: an old sender's message
        values = []
    assert got.address == address
    assert all(map(same, got.arguments, values))  # at most the padding of the last is missing
    assert len(got.arguments) == len(values)


def test_a_message_of_as_many_arguments_as_is_allowed_is_read_and_no_longer_one(wire):
    (got,) = unpack(wire.message("/a", *[1] * limits.ARGUMENTS))
    assert len(got.arguments) == limits.ARGUMENTS
    for tags in ("i" * (limits.ARGUMENTS + 1), "T" * (limits.PACKET - 100), "[" * 40_000):
        with pytest.raises(PacketError, match="arguments"):
            unpack(wire.message("/a", *[1] * len(tags), tags=tags))


def test_a_bundle_is_read_a_step_at_a_time_and_none_of_it_is_kept(wire):
    inner = wire.bundle(None, *[b"/\0\0\0"] * 10)
    packet = wire.bundle(None, *[inner] * (limits.PACKET // 140))
    taken = steps(packet)
    tracemalloc.start()
    try:
        count = sum(message is not None for message in taken)
        _, most = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert count == 10 * (limits.PACKET // 140)
    assert most < 50_000
    assert all(message is None for message in itertools.islice(steps(packet), count))
    assert list(steps(wire.bundle(None, *[wire.bundle(None)] * 1000))) == [None] * 2002
