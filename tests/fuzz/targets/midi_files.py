"""MIDI files: any bytes, and files that are built of parts."""

from __future__ import annotations

import math
import re
import struct
from pathlib import Path

import mido
from fuzz.target import Program, target, written
from midi_bytes import END, chunk, mac_binary, number, riff

from yehu_server.errors import ScoreError
from yehu_server.scores.score import MAX_DURATION_H, Score
from yehu_server.scores.smf.reader import read_score
from yehu_server.scores.smf.track import DamagedError

MOST_PARTS, MOST_EVENTS, MOST_SONGS = 64, 4096, 3
NO_SONG = re.compile("there is no song|has nothing to play")


@target(
    "midi-file",
    ScoreError,
    words=(b"MThd\0\0\0\6", b"MTrk", b"RIFF", b"RMIDdata", b"\xff\x51\3", b"\xff\x2f\0", b"\xf0\4"),
)
def midi_file(data: bytes) -> None:
    """A file is a score of valid messages in order within two hours, or a ScoreError."""
    read_and_checked(data)


@target("midi-structure", ScoreError, words=(b"\0\0\1\x60", b"\1\x30\x43\x5a", b"\4\0\xff\xff"))
def midi_structure(data: bytes) -> None:
    """A file whose parts are whole, or damaged one by one, is read or refused as any other.

    The bytes are a program: the wrapper, then headers, tracks and junk; see `built`.
    """
    read_and_checked(built(Program(data)))


def read_and_checked(data: bytes) -> None:
    """Read a file, also strictly and each of its songs. Errors: those of `read_score`."""
    path = written(data, "file.mid")
    score = read_score(path)
    assert score.events
    check_score(score)
    for warning in score.warnings:
        at = re.fullmatch(r".*at byte (\d+)", warning)
        assert at, warning
        assert int(at[1]) <= len(data), warning
    try:
        assert len(read_score(path, strict=True).events) == len(score.events)
    except DamagedError:
        assert score.warnings
    else:
        assert not score.warnings
    songs = [read_song(path, number) for number in range(1, MOST_SONGS + 1)]
    resets = sum(event.message.type == "reset" for event in score.events)
    assert sum(song is not None for song in songs) <= resets + 1


def check_score(score: Score) -> None:
    """Every message is valid, and at its time."""
    times = [event.time_s for event in score.events]
    assert times == sorted(times)
    assert 0.0 <= times[0] <= times[-1] <= score.duration_s <= MAX_DURATION_H * 3600
    assert math.isfinite(score.duration_s)
    for event in score.events:
        message = event.message
        assert message.type == "reset" or hasattr(message, "channel")
        assert mido.Message.from_bytes(message.bytes()) == message


def read_song(path: Path, number: int) -> Score | None:
    """One song of a file that is read as a whole; None where it has no such song."""
    try:
        song = read_score(path, song=number)
    except ScoreError as refusal:
        if not NO_SONG.search(str(refusal)):
            raise AssertionError(number) from refusal
        return None
    check_score(song)
    assert not any(event.message.type == "reset" for event in song.events)
    return song


def built(program: Program) -> bytes:
    """A MIDI file by a program of bytes."""
    wrapper = program.byte()
    parts = [header(program)]
    while program and len(parts) < MOST_PARTS:
        kind = program.byte() % 8
        if kind == 0:
            parts.append(header(program))
        elif kind == 1:
            parts.append(program.take(program.byte()))
        elif kind == 2:
            parts.append(chunk(b"XFIH", program.take(program.byte() % 16)))
        else:
            parts.append(sized(b"MTrk", track(program), program))
    whole = b"".join(parts)
    if wrapper % 8 == 1:
        return riff(whole)
    if wrapper % 8 == 2:
        return mac_binary(whole)
    return bytes(wrapper) + whole if wrapper % 8 == 3 else whole


def header(program: Program) -> bytes:
    """A header, mostly whole."""
    kind, count, high, low = program.full(4)
    division = (high if high > 0x7F else high % 8) << 8 | low
    return sized(b"MThd", struct.pack(">HHH", kind % 4, count % 8, division), program)


def sized(tag: bytes, body: bytes, program: Program) -> bytes:
    """A chunk; for one in four the length is wrong."""
    choice = program.byte()
    if choice % 4:
        return chunk(tag, body)
    length = int.from_bytes(program.take(4), "big") if choice & 4 else len(body) + choice // 8 - 16
    return chunk(tag, body, length % 2**32)


def track(program: Program) -> bytes:
    """Events of all kinds."""
    out = b""
    for _ in range(MOST_EVENTS):
        if not program:
            break
        head = program.byte()
        out += number(head >> 4 << (program.byte() % 28 if head & 8 else 0))
        match head & 7:
            case 0:
                return out + (b"" if head & 8 else END[1:])
            case 1:
                out += program.take(program.byte() % 8)  # anything
            case 2:
                out += b"\xff\x51\3" + program.full(3)
            case 3:
                body = program.take(program.byte() % 16)
                out += bytes([0xF0 | program.byte() % 2 * 7]) + number(len(body)) + body
            case 4:
                body = program.take(program.byte() % 16)
                out += b"\xff" + bytes([program.byte() % 0x60]) + number(len(body)) + body
            case 5:
                out += bytes(byte & 0x7F for byte in program.full(2))  # running status
            case _:
                status, *body = program.full(3)
                status |= 0x80
                status &= 0xFF if status < 0xF0 else 0x9F
                lone = status & 0xE0 == 0xC0
                out += bytes([status, *(byte & 0x7F for byte in body[: 2 - lone])])
    return out
