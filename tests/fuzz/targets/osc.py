"""OSC packets, and the two framings of packets in a stream."""

import math
from collections.abc import Iterable

from fuzz.target import target, words

from yehu_server.live.osc.packets import Message, PacketError, answer, pack, unpack
from yehu_server.live.osc.peers import Framing, FramingError

MAX_WRAPPED_BYTES = 60_000  # fit a packet of either framing
WORDS = words(
    b"#bundle\x00|/yehu/note\x00\x00|,ff\x00|,[f]|,b\x00\x00|\x00\x00\x00\x01|\xff\xff\xff"
)


def messages(packet: bytes) -> list[Message]:
    return list(unpack(packet))


def can_be_sent(argument: object) -> bool:
    """Whether it can be sent: floats go out in 32 bits."""
    if isinstance(argument, float):
        return not 3e38 < abs(argument) < math.inf
    return isinstance(argument, str | bool)


@target("osc-packet", PacketError, words=WORDS)
def osc_packet(data: bytes) -> None:
    """A packet is messages that read the same when they are written again, or a PacketError."""
    for message in messages(data):
        assert message.address.startswith("/")
        assert message.due_s is None or math.isfinite(message.due_s)
        written = [answer(message.address, message.payload)]
        if all(map(can_be_sent, message.arguments)):
            written.append(pack(message.address, *message.arguments))
        for packet in written:
            (again,) = messages(packet)
            assert again.address == message.address
            assert len(again.arguments) == len(message.arguments)
        assert repr(messages(written[0])[0].arguments) == repr(message.arguments)


def received(framing: Framing, pieces: Iterable[bytes]) -> tuple[list[bytes], bool]:
    """The packets of a stream, and whether it was refused."""
    packets: list[bytes] = []
    try:
        for piece in pieces:
            packets += framing.packets(piece)
    except FramingError:
        return packets, True
    return packets, False


def check_stream(stream: bytes, piece_bytes: int) -> None:
    pieces = (stream[at : at + piece_bytes] for at in range(0, len(stream), piece_bytes))
    packets, is_refused = received(Framing(), pieces)
    whole, whole_is_refused = received(Framing(), [stream])
    assert is_refused == whole_is_refused
    assert packets[: len(whole)] == whole  # a refused stream may lose the packets before the damage
    for packet in packets:
        try:
            messages(packet)
        except PacketError:
            continue


def check_wrapping(begin: bytes, packets: Iterable[bytes]) -> None:
    """Packets that one end frames are those that the other reads."""
    here, there = Framing(), Framing()
    list(here.packets(begin))
    for packet in packets:
        assert list(there.packets(here.wrap(packet))) == [packet]


def check_framing(begin: bytes, data: bytes) -> None:
    """Check framing both ways; the data's first byte says how the stream is cut."""
    check_stream(begin + data[1:], 1 + int.from_bytes(data[:1], "big"))
    content = data[1:MAX_WRAPPED_BYTES]
    check_wrapping(begin, [b"/" + content, b"#bundle\0" + content])


@target("osc-slip", words=(*WORDS, b"\xc0", b"\xdb\xdc", b"\xdb\xdd", b"\xc0\xc0"))
def osc_slip(data: bytes) -> None:
    """A stream of SLIP gives the same packets however it is cut, or is refused."""
    check_framing(b"\xc0", data)


@target("osc-prefixed", words=(*WORDS, b"\0\0\0\4", b"\0\0\0\x0c", b"\0\x10\0\0"))
def osc_prefixed(data: bytes) -> None:
    """A stream of lengths and packets gives the same ones however it is cut, or is refused."""
    check_framing(b"\0", data)
