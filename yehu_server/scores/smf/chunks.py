"""Find the chunks of a MIDI file, also within RIFF, or behind a mail or a MacBinary header.

An error names the kind of a file that is no MIDI file, so that its owner knows what to do with it.
Headers and tracks are found also where lengths are wrong.
"""

import re
import struct
from dataclasses import dataclass, field

from yehu_server.errors import ScoreError
from yehu_server.scores.smf.track import DamageReport, Decoded, Track, decode

JUNK_BYTES = 65_536  # among which a header is searched
HEADER = b"MThd\0\0\0"  # with the length that all headers have, so that prose is none
MAX_PARTS = 131_070  # of a RIFF file

# Where, which bytes, and what they begin. An archive may have a MIDI file within as it is, but
# also several, and names.
ARCHIVES: tuple[tuple[int, bytes, str], ...] = (
    (0, b"\x1f\x8b", "it is compressed by gzip; unpack it first"),
    (0, b"PK\x03\x04", "it is a zip archive; unpack it first"),
    (0, b"BZh", "it is compressed by bzip2; unpack it first"),
    (0, b"\xfd7zXZ", "it is compressed by xz; unpack it first"),
    (0, b"\x28\xb5\x2f\xfd", "it is compressed by zstd; unpack it first"),
    (0, b"7z\xbc\xaf\x27\x1c", "it is a 7z archive; unpack it first"),
    (0, b"Rar!", "it is a rar archive; unpack it first"),
    (0, b"SIT!", "it is a StuffIt archive; unpack it first"),
    (0, b"StuffIt", "it is a StuffIt archive; unpack it first"),
    (2, b"-lh", "it is an LHA archive; unpack it first"),
    (257, b"ustar", "it is a tar archive; unpack it first"),
)
OTHERS: tuple[tuple[int, bytes, str], ...] = (
    (0, b"(This file must be converted with BinHex", "it is encoded by BinHex; decode it first"),
    (0, b"begin 6", "it is encoded by uuencode; decode it first"),
    (0, b"TVRoZA", "it is encoded in base64; decode it first"),
    (0, b"\0\x05\x16\x07", "it is what a Macintosh keeps beside a file; the music is in the other"),
    (0, b"SMF2CLIP", "it is a clip of MIDI 2.0"),
    (0, b"XMF_", "it is an XMF file"),
    (0, b"MMMD", "it is a SMAF ringtone"),
    (0, b"MUS\x1a", "it is a MUS file of a game"),
    (0, b"HMI-MIDISONG", "it is an HMI file of a game"),
    (0, b"HMIMIDIP", "it is an HMP file of a game"),
    (0, b"FORM", "it is an IFF file, as XMI files of games are"),
    (8, b"WAVE", "it is a sound file"),
    (0, b"fLaC", "it is a sound file"),
    (0, b"OggS", "it is a sound file"),
    (0, b"ID3", "it is a sound file"),
    (0, b"%PDF", "it is a PDF"),
    (0, b"<!", "it is a web page or XML"),
    (0, b"<html", "it is a web page"),
    (0, b"<HTML", "it is a web page"),
    (0, b"<?xml", "it is XML"),
)
MAX_EVENTS = 1_000_000  # of any kind; a message takes some 0.5 kB in memory
MAX_TRACKS = 65_535  # as many as a header can announce
MAX_CHUNKS = 2 * MAX_TRACKS
HEAD_BYTES = 14  # of a header chunk
NEXT = re.compile(rb"MT(?:rk|hd)")
OURS = (b"MThd", b"MTrk")


def unwrapped(data: bytes, faults: DamageReport) -> tuple[int, int]:
    """Return where the MIDI file begins and ends. Raises ScoreError where no header is found."""
    start, end = 0, len(data)
    if data[:4] == b"RIFF" and data[8:12] == b"RMID":
        start, end = _of_riff(data)
    if data[start : start + 4] == b"MThd":
        return start, end
    archive = _kind_of(data, ARCHIVES)
    found = -1 if archive else data.find(HEADER, start, start + JUNK_BYTES + len(HEADER))
    if found < 0:
        kind = archive or _kind_of(data, OTHERS) or _missing(data)
        raise ScoreError(f"is not a MIDI file: {kind}")
    faults.add(f"{found - start} bytes before the header skipped", start)
    return found, end


def _of_riff(data: bytes) -> tuple[int, int]:
    """The bytes within the wrapper; its lengths are little-endian, its parts are padded."""
    pos, end = 12, len(data)
    for _ in range(MAX_PARTS):
        if pos + 8 > end:
            break
        length = int.from_bytes(data[pos + 4 : pos + 8], "little")
        if data[pos : pos + 4] == b"data":
            inside = data[pos + 8 : pos + 12] == b"MThd"
            return (pos + 8, min(pos + 8 + length, end)) if inside else (0, end)
        pos += 8 + length + length % 2
    return 0, end


def _kind_of(data: bytes, kinds: tuple[tuple[int, bytes, str], ...]) -> str:
    text = data[:512].lstrip(b"\xef\xbb\xbf \t\r\n")  # a web page may begin with empty lines
    for at, magic, kind in kinds:
        if data[at : at + len(magic)] == magic or (at == 0 and text.startswith(magic)):
            return kind
    return ""


def _missing(data: bytes) -> str:
    if not data.strip(b"\0"):
        return "all of its bytes are zero"
    if b"MTrk" in data[: JUNK_BYTES + 4]:
        return "it has a track and no header (MThd)"
    if min(data[:512]) >= ord("\t"):  # no other control characters
        return "it is text; scores in text are named .jianpu, .abc or .musicxml"
    return f"there is no header (MThd) in the first {JUNK_BYTES // 1024} kB"


@dataclass(frozen=True)
class Part:
    """A header and the tracks that follow it; files that were joined have several."""

    at: int  # byte of the header
    file_format: int
    announced: int  # tracks
    division: int
    tracks: list[Track] = field(default_factory=list)


def read_parts(decoded: Decoded, start: int, end: int, faults: DamageReport) -> list[Part]:
    """Read the header and the tracks of a file, or of several that were joined.

    They lie from byte `start`, where a header begins, to `end`; their messages are added to
    `decoded`. Raises ScoreError where the first header is damaged, or where there is more than
    memory should hold.
    """
    parts: list[Part] = []
    data = decoded.data
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
            track, pos = _track(decoded, pos, end, room, faults)
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


def _track(
    decoded: Decoded, at: int, end: int, room: int, faults: DamageReport
) -> tuple[Track, int]:
    """A track, and the byte after it.

    Its length is believed where a chunk follows or the file ends. If not, the track is read up to
    its own end, or to where the next one seems to begin.
    """
    data = decoded.data
    declared = at + 8 + _length(data, at)
    believed = declared <= end and at + 8 <= end and is_chunk(data, declared, end)
    stop = declared if believed else _next(data, min(at + 8, end), end)
    track = decode(decoded, min(at + 8, stop), stop, room, faults)
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
