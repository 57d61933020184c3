"""MIDI files byte by byte, for tests."""

import struct

END = b"\x00\xff\x2f\x00"


def number(value: int) -> bytes:
    """A variable-length number."""
    digits = [value & 0x7F]
    while value := value >> 7:
        digits.insert(0, value & 0x7F | 0x80)
    return bytes(digits)


def tempo(delta: int, microseconds: int) -> bytes:
    return number(delta) + b"\xff\x51\x03" + microseconds.to_bytes(3, "big")


def on(delta: int, note: int, velocity: int = 80, channel: int = 0) -> bytes:
    return number(delta) + bytes([0x90 | channel, note, velocity])


def off(delta: int, note: int, channel: int = 0) -> bytes:
    return number(delta) + bytes([0x80 | channel, note, 0])


def chunk(tag: bytes, body: bytes, length: int | None = None) -> bytes:
    """A chunk, with a length of its own where one is given."""
    return tag + struct.pack(">I", len(body) if length is None else length) + body


def head(kind: int, count: int, division: int, extra: bytes = b"") -> bytes:
    return chunk(b"MThd", struct.pack(">HHH", kind, count, division) + extra)


def midi(
    *tracks: bytes, kind: int = 1, division: int = 100, count: int | None = None, extra: bytes = b""
) -> bytes:
    """A file of tracks."""
    first = head(kind, len(tracks) if count is None else count, division, extra)
    return first + b"".join(chunk(b"MTrk", track) for track in tracks)


def riff(inner: bytes, length: int | None = None, before: bytes = b"") -> bytes:
    """A file in a RIFF wrapper, with parts before it."""
    length = len(inner) if length is None else length
    body = b"RMID" + before + b"data" + struct.pack("<I", length) + inner
    body += b"\0" * (len(inner) % 2)
    return b"RIFF" + struct.pack("<I", len(body)) + body
