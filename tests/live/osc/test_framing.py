"""Packets in streams: both framings, cut anywhere, and damaged."""

import itertools
import struct
from collections.abc import Iterable

import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from pythonosc import slip

from yehu_server.live.osc.peers import Framing, FramingError

ESC, END = b"\xdb", b"\xc0"
MAX_BYTES = 65_535  # of a packet: as long as UDP allows


def prefixed(packets: Iterable[bytes]) -> bytes:
    return b"".join(struct.pack(">I", len(packet)) + packet for packet in packets)


def slipped(packets: Iterable[bytes]) -> bytes:
    """SLIP of OSC 1.1: an END before and after each packet."""
    return b"".join(slip.encode(packet) for packet in packets)


def slipped_bare(packets: Iterable[bytes]) -> bytes:
    """SLIP of RFC 1055's first sketch: an END after each packet only."""
    return b"".join(slip.encode(packet)[1:] for packet in packets)


def read(framing: Framing, *pieces: bytes) -> list[bytes]:
    return [packet for piece in pieces for packet in framing.packets(piece)]


FRAMINGS = [prefixed, slipped, slipped_bare]
SOME = [b"/a\0\0", b"/" + END * 3 + ESC * 2, b"#bundle\0", b"/\xdb\xdc\xdb\xdd\0", b"/b" * 300]
# The first byte decides the framing: SLIP without a leading END begins with that of a packet.
osc_like = st.builds(lambda start, rest: start + rest, st.sampled_from([b"/", b"#"]), st.binary())
awkward = st.lists(st.sampled_from([END, ESC, b"\xdc", b"\xdd", b"\0", b"/"])).map(b"".join)
packets = st.lists(osc_like | awkward.map(lambda rest: b"/" + rest), max_size=8)


@pytest.mark.parametrize("frame", FRAMINGS)
@given(packets, st.lists(st.integers(0, 400)))
@example(SOME, range(1, 700))
def test_what_is_framed_comes_out_again_however_it_is_cut(frame, packets, cuts):
    stream = frame(packets)
    edges = [0, *sorted(cut for cut in cuts if cut < len(stream)), len(stream)]
    pieces = [stream[a:b] for a, b in itertools.pairwise(edges)]
    assert read(Framing(), *pieces) == packets


@given(st.binary())
def test_answers_are_framed_as_the_peer_frames(packet):
    by_length, by_slip, unknown = Framing(), Framing(), Framing()
    read(by_length, b"\0")
    read(by_slip, b"/")
    assert by_length.wrap(packet) == prefixed([packet])
    assert by_slip.wrap(packet) == unknown.wrap(packet) == slip.encode(packet)


def test_a_packet_may_be_as_long_as_is_allowed_and_no_longer():
    longest = b"/" * MAX_BYTES
    assert read(Framing(), prefixed([longest])) == [longest]
    for packet in (longest, b"/" + END * (MAX_BYTES - 1)):  # SLIP sends an END as two bytes
        assert read(Framing(), slipped([packet])) == [packet]
    with pytest.raises(FramingError, match="too long"):
        read(Framing(), prefixed([longest + b"/"])[:4])
    with pytest.raises(FramingError, match="too long"):
        read(Framing(), slipped([longest + b"/"]))


@pytest.mark.parametrize("start", [END + b"/", b"/", b"#"])
def test_a_stream_that_never_ends_a_packet_is_given_up(start):
    framing = Framing()
    with pytest.raises(FramingError, match="too long"):
        read(framing, start, *([b"x" * 65536] * 64))
    assert len(framing._received) <= 3 * MAX_BYTES


STUN = bytes.fromhex("0003 0000 2112a442") + b"0123456789ab"  # a TURN allocation request
SAID_BY_OTHERS = [
    b"GET / HTTP/1.1\r\n\r\n",
    b"POST / HTTP/1.1\r\nContent-Length: 8\r\n\r\n\xc0/a\0\0\xc0",
    b"OPTIONS * HTTP/1.1\r\n\r\n",
    b"\x16\x03\x01\x02\x00\x01\x00",  # TLS
    STUN,
    b"\x00\x01\x00\x00" + STUN[4:],
    b"\x00\x14" + STUN,  # between browsers
    b"\xff",
    ESC + b"\xdc",
    b"\r\n/a\0\0\xc0",
    b"\0\0\0\x04P",
    b"\0\0\0\x04\0",
    END + b"P",
    END * 3 + b"\0",
]


def test_what_is_no_osc_ends_a_stream_with_the_first_byte_that_no_packet_begins_with(subtests):
    for said in [*SAID_BY_OTHERS, b"\0\0\0\x08G"]:
        with subtests.test(said=said):
            with pytest.raises(FramingError):
                read(Framing(), said + b"\xc0/a\0\0\xc0")
            if said[0] == 0:  # a length comes first
                continue
            wrong = next(at for at in range(len(said)) if said[at : at + 1] != END)
            for before in (b"", END, slipped(SOME), slipped_bare(SOME)):
                got: list[bytes] = []
                with pytest.raises(FramingError, match="not OSC"):
                    got.extend(Framing().packets(before + said[: wrong + 1]))
                assert got == (SOME if len(before) > 1 else [])


class Sought(bytearray):
    """Counts the bytes searched for another."""

    count = 0

    def find(self, what: bytes, start: int = 0) -> int:
        Sought.count += len(self) - start
        return super().find(what, start)


def test_no_byte_of_a_slip_packet_that_comes_in_pieces_is_looked_at_again():
    framing = Framing()
    framing._received, Sought.count = Sought(), 0
    packet = b"/" + b"x" * 60_000
    assert read(framing, END, *(packet[at : at + 100] for at in range(0, 60_001, 100))) == []
    assert Sought.count == len(packet)
    assert read(framing, END) == [packet]
