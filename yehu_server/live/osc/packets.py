"""Read and write OSC packets.

python-osc does neither here. It accepts damaged packets, and never ends with some; to write one, of
which subscribers are sent hundreds at a time, takes it seven times as long.
"""

import struct
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any

from yehu_server.live import traffic_limits as limits

BUNDLE = b"#bundle\0"
IMMEDIATELY = (0, 1)  # as a time tag
SECONDS_1900_TO_1970 = 2_208_988_800
HEADS_KEPT, LONGEST_KEPT = 1024, 256  # addresses with type tags, and their bytes


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
    try:
        if not packet.startswith(BUNDLE):
            yield _message(packet, None)
            return
        data = memoryview(packet)
        for _ in _bundle(data, None, limits.NESTING):
            yield None
        yield from _bundle(data, None, limits.NESTING)
    except (struct.error, UnicodeDecodeError) as error:
        raise PacketError("cut short, or not text") from error


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
        if data[start : start + 8] == BUNDLE:
            yield from _bundle(data[start:place], due_s, depth - 1)
        else:
            yield _message(bytes(data[start:place]), due_s)


def _message(data: bytes, due_s: float | None) -> Message:
    if data[:1] != b"/":
        raise PacketError("an address begins with /")
    tags_at = _after_text(data, 0)
    if tags_at == len(data):  # old senders omit the tags where there are no arguments
        return Message(_text(data, 0), [], due_s)
    start = _after_text(data, tags_at)
    read = _head if start <= LONGEST_KEPT else _head.__wrapped__
    address, tags, numbers = read(data[:start], tags_at)
    if numbers is None:
        arguments, end = _arguments(data, tags, start)
    else:
        arguments, end = list(numbers.unpack_from(data, start)), start + numbers.size
    if end != len(data):
        raise PacketError("more or fewer arguments than type tags")
    return Message(address, arguments, due_s, data[tags_at:])


@lru_cache(HEADS_KEPT)
def _head(head: bytes, tags_at: int) -> tuple[str, str, struct.Struct | None]:
    """Address and tags before a message's arguments, and these where all have fixed lengths."""
    address, tags = _text(head, 0), _text(head, tags_at)
    if not tags.startswith(","):
        raise PacketError("no type tags")
    if len(tags) - 1 > limits.ARGUMENTS:
        raise PacketError("too many arguments")
    is_fixed = FIXED.keys() >= set(tags[1:])
    form = struct.Struct(">" + "".join(FIXED[tag] for tag in tags[1:])) if is_fixed else None
    return address, tags[1:], form


def _arguments(data: bytes, tags: str, place: int) -> tuple[list[Any], int]:
    """The arguments of a message, which begin at a place, and where they end."""
    lists: list[list[Any]] = [[]]
    for tag in tags:
        if tag == "[":
            if len(lists) > limits.NESTING:
                raise PacketError("arrays are nested too deep")
            lists.append([])
            lists[-2].append(lists[-1])
        elif tag == "]" and len(lists) > 1:
            lists.pop()
        else:
            argument, place = _argument(data, tag, place)
            lists[-1].append(argument)
    if len(lists) > 1:
        raise PacketError("more or fewer arguments than type tags")
    return lists[0], place


def _argument(data: bytes, tag: str, place: int) -> tuple[Any, int]:
    """An argument at a place, and where the next begins."""
    if tag in FIXED:
        form = f">{FIXED[tag]}"
        (value,) = struct.unpack_from(form, data, place)
        return value, place + struct.calcsize(form)
    if tag in CONSTANTS:
        return CONSTANTS[tag], place
    if tag in "sS":
        end = _after_text(data, place)
        return _text(data, place), end
    if tag == "b":
        (size,) = struct.unpack_from(">i", data, place)
        start = place + 4
        if not 0 <= size <= len(data) - start:
            raise PacketError("a blob has a wrong length")
        return data[start : start + size], (start + size + 3) & ~3
    raise PacketError(f"unknown type {tag!r}")


def _text(data: bytes, place: int) -> str:
    return data[place : data.index(b"\0", place)].decode()


def _after_text(data: bytes, place: int) -> int:
    """Where what follows a string begins."""
    end = data.find(b"\0", place)
    if end < 0:
        raise PacketError("a string without an end")
    after = (end + 4) & ~3
    if after > len(data):
        raise PacketError("cut short")
    return after


class Bang:
    """The argument without a value of type I, "infinitum" or "impulse"."""


# Forms of arguments, by type tag, and arguments without a value.
FIXED = dict(zip("ihfdtcrm", ("i", "q", "f", "d", "8s", "4s", "4s", "4s"), strict=True))
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
            tags, data = tags + tag, data + struct.pack(f">{FIXED[tag]}", argument)
        else:
            tags, data = tags + "f", data + struct.pack(">f", argument)
    return _padded(address) + _padded(tags) + data


def _padded(text: str) -> bytes:
    """A string as OSC has it: ended by a NUL, padded to a multiple of four bytes."""
    data = text.encode()
    return data + bytes(4 - len(data) % 4)


def answer(address: str, payload: bytes) -> bytes:
    """Write a message with the type tags and arguments of another."""
    return _padded(address) + payload
