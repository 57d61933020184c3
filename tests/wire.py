"""OSC in bytes, a peer that only listens, and a still clock."""

import math
import struct
from collections import deque
from typing import Any, ClassVar, NamedTuple

import numpy as np

SINCE_1900_S = 2_208_988_800


class Message(NamedTuple):
    """A message as a client reads it."""

    address: str
    arguments: list[Any]


class Wire:
    """OSC 1.0 in bytes, written and read without the package and without python-osc."""

    NUMBERS: ClassVar = {
        "i": ">i",
        "f": ">f",
        "h": ">q",
        "d": ">d",
        "t": ">Q",
        "r": ">I",
        "c": ">I",
    }
    BARE: ClassVar = {"T": True, "F": False, "N": None, "I": math.inf}

    @staticmethod
    def text(text: str) -> bytes:
        data = text.encode()
        return data + b"\0" * (4 - len(data) % 4)

    @classmethod
    def tag(cls, argument: Any) -> str:
        if isinstance(argument, bool):
            return "T" if argument else "F"
        if isinstance(argument, int):
            return "i" if -(2**31) <= argument < 2**31 else "h"
        return {float: "f", str: "s", bytes: "b", type(None): "N"}[type(argument)]

    @classmethod
    def message(cls, address: str, *arguments: Any, tags: str | None = None) -> bytes:
        """A message; its type tags are those given, or follow from the arguments."""
        if tags is None:
            tags = "".join(map(cls.tag, arguments))
        data = bytearray(cls.text(address) + cls.text("," + tags))
        left = deque(arguments)
        for tag in tags:
            if tag in cls.NUMBERS:
                data += struct.pack(cls.NUMBERS[tag], left.popleft())
            elif tag in "sS":
                data += cls.text(left.popleft())
            elif tag == "b":
                blob = left.popleft()
                data += struct.pack(">i", len(blob)) + blob + b"\0" * (-len(blob) % 4)
            elif tag == "m":
                data += bytes(left.popleft())
            elif tag in "TFN" and left:
                left.popleft()
        return bytes(data)

    @staticmethod
    def bundle(at_s: float | None, *elements: bytes) -> bytes:
        """A bundle for a time in seconds since 1970, or for at once."""
        tag = 1
        if at_s is not None:
            whole = math.floor(at_s)
            tag = (whole + SINCE_1900_S << 32) + round((at_s - whole) * 2**32)
        sized = (struct.pack(">i", len(element)) + element for element in elements)
        return b"#bundle\0" + struct.pack(">Q", tag) + b"".join(sized)

    @classmethod
    def read(cls, packet: bytes) -> Message:
        """Parse one message, strictly."""

        def text(at: int) -> tuple[str, int]:
            end = packet.index(0, at)
            after = end + 4 - (end - at) % 4
            assert not any(packet[end:after])
            return packet[at:end].decode(), after

        assert len(packet) % 4 == 0
        address, at = text(0)
        tags, at = text(at)
        assert tags[0] == ","
        arguments: list[Any] = []
        for tag in tags[1:]:
            if tag in cls.NUMBERS:
                (value,) = struct.unpack_from(cls.NUMBERS[tag], packet, at)
                at += struct.calcsize(cls.NUMBERS[tag])
            elif tag == "s":
                value, at = text(at)
            elif tag == "b":
                (size,) = struct.unpack_from(">i", packet, at)
                value = packet[at + 4 : at + 4 + size]
                at += 4 + size + -size % 4
            elif tag in cls.BARE:
                value = cls.BARE[tag]
            else:
                value, at = packet[at : at + 4], at + 4
            arguments.append(value)
        assert at == len(packet)
        return Message(address, arguments)


def f32(value: float) -> float:
    """A number as it goes over the wire."""
    return float(np.float32(value))


def values(heard: list[Message]) -> dict[str, Any]:
    """The first argument of each address."""
    return {message.address: message.arguments[0] for message in heard}


def errors(heard: list[Message]) -> list[str]:
    """The addresses of the errors answered."""
    return [message.arguments[0] for message in heard if message.address == "/yehu/error"]


class FakePeer:
    """A peer who only listens."""

    takes_more = True

    def __init__(self, port: int = 1, host: str = "") -> None:
        self.port = port
        self.name = f"peer:{port}"
        self.host = host or self.name
        self.packets: list[bytes] = []
        self.others: dict[int, FakePeer] = {}

    def send(self, *packets: bytes) -> None:
        self.packets += packets

    def at(self, port: int) -> "FakePeer":
        return self.others.setdefault(port, FakePeer(port, self.host))

    def received(self) -> list[Message]:
        """The messages since the last call."""
        packets, self.packets = self.packets, []
        return [Wire.read(packet) for packet in packets]


class StillTime:
    """A clock that tests move by hand; stands in for the module ``time``."""

    time_ns = None  # code under this clock may not use another
    sleep = None

    def __init__(self, now: float) -> None:
        self.now = now  # s
        self.since_1970 = 1.7e9  # s, of the monotonic clock's zero

    def monotonic(self) -> float:
        return self.now

    def monotonic_ns(self) -> int:
        return round(1e9 * self.now)

    def time(self) -> float:
        return self.since_1970 + self.now
