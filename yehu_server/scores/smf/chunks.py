"""The chunks of a MIDI file: headers and tracks, found also where lengths are wrong."""

from __future__ import annotations

import re
import struct
from dataclasses import dataclass, field

from yehu_server.errors import ScoreError
from yehu_server.scores.smf.faults import DamageReport
from yehu_server.scores.smf.track import Track, decode

MAX_EVENTS = 1_000_000  # of any kind; a message takes some 0.5 kB in memory
MAX_TRACKS = 65_535  # as many as a header can announce
MAX_CHUNKS = 2 * MAX_TRACKS

HEAD_BYTES = 14  # of a header chunk
NEXT = re.compile(rb"MT(?:rk|hd)")
OURS = (b"MThd", b"MTrk")


@dataclass(frozen=True)
class Part:
    """A header and the tracks that follow it; files that were joined have several."""

    at: int  # byte of the header
    file_format: int
    announced: int  # tracks
    division: int
    tracks: list[Track] = field(default_factory=list)


def read_parts(data: bytes, start: int, end: int, faults: DamageReport) -> list[Part]:
    """Read the header and the tracks of a file, or of several that were joined.

    They lie from byte `start`, where a header begins, to `end`. Raises ScoreError where the first
    header is damaged, or where there is more than memory should hold.
    """
    parts: list[Part] = []
    tracks, room, pos = 0, MAX_EVENTS, start
    for _ in range(MAX_CHUNKS + 2):  # after the header, and the end
        if pos >= end:
            return parts
        tag = data[pos : pos + 4]
        if tag == b"MThd":
            part, pos = _header(data, pos, end, faults)
            if part is not None:
                parts.append(part)
            elif not parts:
                raise ScoreError(f"has a damaged header at byte {start}")
        elif tag == b"MTrk":
            if tracks == MAX_TRACKS:
                raise ScoreError(f"has more than {MAX_TRACKS} tracks")
            track, pos = _track(data, pos, end, room, faults)
            if track.events > room:
                raise ScoreError(f"has more than {MAX_EVENTS} events")
            parts[-1].tracks.append(track)
            tracks += 1
            room -= track.events
        elif is_chunk(data, pos, end):
            pos += 8 + _length(data, pos)
        else:
            # The length of the chunk before is wrong, or padding follows it.
            faults.add("bytes outside any chunk skipped", pos)
            pos = _next(data, pos, end)
    raise ScoreError(f"has more than {MAX_CHUNKS} chunks")


def is_chunk(data: bytes, at: int, end: int) -> bool:
    """Whether a chunk begins here, or the file ends."""
    if at == end or data[at : at + 4] in OURS:
        return at <= end
    printable = at + 8 <= end and all(0x20 <= byte < 0x7F for byte in data[at : at + 4])
    return printable and at + 8 + _length(data, at) <= end


def _length(data: bytes, at: int) -> int:
    return int.from_bytes(data[at + 4 : at + 8], "big")


def _next(data: bytes, at: int, end: int) -> int:
    """The next byte at which a header or track seems to begin, or the end."""
    found = NEXT.search(data, at, end)
    return found.start() if found else end


def _header(data: bytes, at: int, end: int, faults: DamageReport) -> tuple[Part | None, int]:
    """A header, or None where it is damaged; and the byte after it."""
    length = _length(data, at)
    after = at + 8 + length
    # A length of 6 is believed whatever follows; another one where a chunk does.
    if length != HEAD_BYTES - 8 and (length < HEAD_BYTES - 8 or not is_chunk(data, after, end)):
        after = _next(data, at + 4, end)
        if after >= at + HEAD_BYTES:
            faults.add("a header of a wrong length read as usual", at + 4)
    if after < at + HEAD_BYTES or at + HEAD_BYTES > end:
        faults.add("a damaged header skipped", at)
        return None, min(max(after, at + 4), end)
    file_format, announced, division = struct.unpack_from(">HHH", data, at + 8)
    return Part(at, file_format, announced, division), after


def _track(data: bytes, at: int, end: int, room: int, faults: DamageReport) -> tuple[Track, int]:
    """A track, and the byte after it.

    Its length is believed where a chunk follows or the file ends. If not, the track is read up to
    its own end, or to where the next one seems to begin.
    """
    declared = at + 8 + _length(data, at)
    believed = declared <= end and at + 8 <= end and is_chunk(data, declared, end)
    stop = declared if believed else _next(data, min(at + 8, end), end)
    track = decode(data, min(at + 8, stop), stop, room, faults)
    if track.after_end is None:
        if declared > end == stop:
            faults.add("the file is cut short", end)
        elif not believed:
            faults.add("a track of a wrong length read up to the next", at + 4)
        elif track.is_whole:
            faults.add("a track without its end read up to the next", stop)
        return track, stop
    if believed and NEXT.match(data, track.after_end, end) is None:
        if track.after_end < declared:
            faults.add("bytes after the end of a track skipped", track.after_end)
        return track, declared
    if track.after_end != declared:
        faults.add("a track of a wrong length read up to its end", at + 4)
    return track, track.after_end
