"""Read and write OSC packets.

python-osc does neither here. It accepts damaged packets, and never ends with some; to write one, of
which subscribers are sent hundreds at a time, takes it seven times as long.
"""

import struct
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

from yehu_server.live import traffic_limits as limits

BUNDLE = b"#bundle\0"
IMMEDIATELY = (0, 1)  # as a time tag
SECONDS_1900_TO_1970 = 2_208_988_800


class PacketError(ValueError):
    """Bytes that are not an OSC packet."""


@dataclass
class Message:
    """An OSC message.

    `due_s` is the time tag of its bundle (seconds since 1970), or None for immediately;
    `payload` the type tags and arguments as received.
    """

    address: str
    arguments: Sequence[Any]
    due_s: float | None = None
    payload: bytes = field(default=b"", compare=False)


def unpack(packet: bytes) -> list[Message]:
    """The messages of a packet, in order; raises PacketError where any part of it is damaged."""
    return [message for message in steps(packet) if message is not None]


def steps(packet: bytes) -> Iterator[Message | None]:
    """The messages of a packet, one at a time, in short steps: those without a message give None.

    A bundle is checked to its end before its first message is given, and then read again: unpacked
    it would take fifty times the memory. Raises PacketError where any part of it is damaged; before
    the first message.
    """
    data = memoryview(packet)
    try:
        if packet.startswith(BUNDLE):
            for _ in _content(data, None, limits.NESTING):
                yield None
        yield from _content(data, None, limits.NESTING)
    except (struct.error, UnicodeDecodeError) as error:
        raise PacketError("cut short, or not text") from error


def _content(data: memoryview, due_s: float | None, depth: int) -> Iterator[Message | None]:
    if bytes(data[:8]) == BUNDLE:
        yield from _bundle(data, due_s, depth)
    elif bytes(data[:1]) == b"/":
        yield _message(data, due_s)
    else:
        raise PacketError("an address begins with /")


def _bundle(data: memoryview, due_s: float | None, depth: int) -> Iterator[Message | None]:
    if depth == 0:
        raise PacketError("bundles are nested too deep")
    yield None
    tag = struct.unpack_from(">II", data, 8)
    if tag != IMMEDIATELY:
        due_s = tag[0] - SECONDS_1900_TO_1970 + tag[1] / 2.0**32
    place = 16
    while place < len(data):
        (size,) = struct.unpack_from(">i", data, place)
        start, place = place + 4, place + 4 + size
        if size <= 0 or size % 4 != 0 or place > len(data):
            raise PacketError("an element of a bundle has a wrong length")
        yield from _content(data[start:place], due_s, depth - 1)


def _message(data: memoryview, due_s: float | None) -> Message:
    reader = _Reader(data)
    address = reader.text()
    payload = bytes(data[reader.place :])
    if not payload:  # old senders omit the tags where there are no arguments
        return Message(address, [], due_s)
    tags = reader.text()
    if not tags.startswith(","):
        raise PacketError("no type tags")
    if len(tags) - 1 > limits.ARGUMENTS:
        raise PacketError("too many arguments")
    arguments: list[Any] = []
    lists = [arguments]
    for tag in tags[1:]:
        if tag == "[":
            if len(lists) > limits.NESTING:
                raise PacketError("arrays are nested too deep")
            lists.append([])
            lists[-2].append(lists[-1])
        elif tag == "]" and len(lists) > 1:
            lists.pop()
        else:
            lists[-1].append(reader.argument(tag))
    if len(lists) > 1 or reader.place != len(data):
        raise PacketError("more or fewer arguments than type tags")
    return Message(address, arguments, due_s, payload)


class _Reader:
    """Reads a message from front to back; raises struct.error or PacketError beyond its end."""

    def __init__(self, data: memoryview) -> None:
        self._data = data
        self._bytes = bytes(data)
        self.place = 0

    def text(self) -> str:
        end = self._bytes.find(b"\0", self.place)
        if end < 0:
            raise PacketError("a string without an end")
        text = self._bytes[self.place : end].decode()
        self._skip_to(end + 1)
        return text

    def argument(self, tag: str) -> Any:
        if tag in FIXED:
            form = FIXED[tag]
            (value,) = form.unpack_from(self._data, self.place)
            self.place += form.size
            return value
        if tag in CONSTANTS:
            return CONSTANTS[tag]
        if tag in "sS":
            return self.text()
        if tag == "b":
            (size,) = struct.unpack_from(">i", self._data, self.place)
            start = self.place + 4
            if size < 0:
                raise PacketError("a blob has a wrong length")
            self._skip_to(start + size)
            return self._bytes[start : start + size]
        raise PacketError(f"unknown type {tag!r}")

    def _skip_to(self, place: int) -> None:
        """Continue at the next multiple of four."""
        self.place = (place + 3) & ~3
        if self.place > len(self._data):
            raise PacketError("cut short")


class Bang:
    """The argument without a value of type I, "infinitum" or "impulse"."""


FIXED = {
    tag: struct.Struct(f">{form}")
    for tag, form in {"i": "i", "h": "q", "f": "f", "d": "d", "t": "8s", "c": "4s", "r": "4s",
                      "m": "4s"}.items()
}  # fmt: skip
CONSTANTS = {"T": True, "F": False, "N": None, "I": Bang()}


def pack(address: str, *arguments: float | str | bool) -> bytes:
    """Write a message as a packet: numbers as f, i or h, and strings."""
    tags, data = ",", b""
    for argument in arguments:
        if isinstance(argument, str):
            tags, data = tags + "s", data + _padded(argument)
        elif isinstance(argument, bool):
            tags += "T" if argument else "F"
        elif isinstance(argument, int):
            tag = "i" if -(1 << 31) <= argument < 1 << 31 else "h"
            tags, data = tags + tag, data + FIXED[tag].pack(argument)
        else:
            tags, data = tags + "f", data + FIXED["f"].pack(argument)
    return _padded(address) + _padded(tags) + data


def _padded(text: str) -> bytes:
    """A string as OSC has it: ended by a NUL, padded to a multiple of four bytes."""
    data = text.encode()
    return data + bytes(4 - len(data) % 4)


def answer(address: str, payload: bytes) -> bytes:
    """Write a message with the type tags and arguments of another."""
    return _padded(address) + payload
