"""A corpus of MIDI files with one fault each, and what becomes of each.

    .venv/bin/python tests/midi_faults.py FOLDER

writes the files and `expected.json`. docs/midi_files.md describes them.
"""

import gzip
import io
import json
import sys
import zipfile
from dataclasses import dataclass
from pathlib import Path

from midi_bytes import END, chunk, head, midi, number, off, on, riff, tempo

Notes = tuple[tuple[float, int], ...]  # beginnings (s) and keys

FIRST, SECOND = on(0, 67) + off(96, 67), on(0, 69) + off(96, 69)
TUNE = FIRST + SECOND + END
LATE = on(96, 69) + off(96, 69) + END
SLOW = on(0, 67) + off(500, 67) + on(0, 69) + off(500, 69) + END
BOTH: Notes = ((0.0, 67), (0.5, 69))
REST = b"\xff\xff\xff\x7f"  # the longest


@dataclass(frozen=True)
class Case:
    """A file with a fault.

    Parameters
    ----------
    hears : tuple or None
        The beginnings (s) and keys of its notes; None where it is refused.
    says : str
        The warnings, or the reason of the refusal.
    """

    name: str
    data: bytes
    says: str = ""
    hears: Notes | None = BOTH


def song(*tracks: bytes, kind: int = 0, division: int = 96, count: int | None = None) -> bytes:
    return midi(*tracks, kind=kind, division=division, count=count)


def track(body: bytes, length: int | None = None) -> bytes:
    return chunk(b"MTrk", body, length)


def zipped(data: bytes) -> bytes:
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr(zipfile.ZipInfo("tune.mid"), data)
    return file.getvalue()


def refused(name: str, data: bytes, says: str) -> Case:
    return Case(name, data, says, None)


ONE = head(0, 1, 96)
WHOLE = song(TUNE)
NO = "is not a MIDI file: "

WRAPPED = (
    Case("riff", riff(WHOLE, before=b"LIST\x03\0\0\0abc\0")),
    Case("riff-of-a-wrong-length", riff(WHOLE, length=9999)),
    Case(
        "junk-before",
        b"From: a friend\nSubject: the tune\n\n" + WHOLE,
        "34 bytes before the header skipped, at byte 0",
    ),
    refused(
        "junk-of-more-than-64-kb",
        b"\1" * 65_537 + WHOLE,
        NO + "there is no header (MThd) in the first 64 kB",
    ),
    refused(
        "gzip", gzip.compress(WHOLE, mtime=0), NO + "it is compressed by gzip; unpack it first"
    ),
    refused("zip", zipped(WHOLE), NO + "it is a zip archive; unpack it first"),
    refused(
        "binhex",
        b"(This file must be converted with BinHex 4.0)\n:",
        NO + "it is encoded by BinHex; decode it first",
    ),
    refused(
        "beside-a-file",
        b"\0\x05\x16\x07\0\2\0\0",
        NO + "it is what a Macintosh keeps beside a file; the music is in the other",
    ),
    refused("web-page", b"\n<!DOCTYPE html><title>404</title>", NO + "it is a web page or XML"),
    refused("wave", b"RIFF\x24\0\0\0WAVEfmt \x10\0\0\0", NO + "it is a sound file"),
    refused("zeros", bytes(512), NO + "all of its bytes are zero"),
    refused("empty", b"", "is empty"),
)

HEADERS = (
    Case("smpte", song(SLOW, division=0xE728)),
    Case(
        "division-0",
        song(on(0, 67) + off(480, 67) + on(0, 69) + off(480, 69) + END, division=0),
        "a division of 0: 480 ticks a quarter note assumed, at byte 12",
    ),
    Case(
        "smpte-division-0",
        song(SLOW, division=0xE700),
        "a division of 0: 40 ticks a frame assumed, at byte 12",
    ),
    Case(
        "smpte-frames-of-no-film",
        song(SLOW, division=0xCE14),
        "50 frames a second, as no film has, believed, at byte 12",
    ),
    Case("format-above-2", song(TUNE, kind=9), "unknown format 9, read as format 1, at byte 8"),
    Case(
        "format-0-of-two-tracks",
        song(FIRST + END, LATE),
        "format 0 with 2 tracks, read as format 1, at byte 8",
    ),
    Case(
        "fewer-tracks-than-announced",
        song(TUNE, kind=1, count=3),
        "3 tracks announced, 1 found, at byte 10",
    ),
    Case(
        "more-tracks-than-announced",
        song(FIRST + END, LATE, kind=1, count=1),
        "1 track announced, 2 found, at byte 10",
    ),
    Case(
        "header-of-a-wrong-length",
        b"MThd\0\0\0\0" + ONE[8:] + track(TUNE),
        "a header of a wrong length read as usual, at byte 4",
    ),
    refused("header-cut-short", b"MThd\0\0\0\6\0\1", "has a damaged header at byte 0"),
    refused("no-header", track(TUNE), NO + "it has a track and no header (MThd)"),
    Case(
        "two-files-joined",
        song(FIRST + END) + song(SECOND + END),
        "another file within the file, played after the one before, at byte 34",
    ),
)

TRACKS = (
    Case(
        "cut-short",
        song(TUNE + on(0, 71) + off(96, 71))[:-3].replace(END, b""),
        "a track ends in the middle of an event, at byte 42; the file is cut short, at byte 43",
        hears=(*BOTH, (1.0, 71)),
    ),
    Case(
        "cut-between-events", ONE + track(FIRST + SECOND, 99), "the file is cut short, at byte 38"
    ),
    Case(
        "no-end-of-track",
        song(FIRST + SECOND),
        "a track without its end read up to the next, at byte 38",
    ),
    Case(
        "length-0", ONE + track(TUNE, 0), "a track of a wrong length read up to its end, at byte 18"
    ),
    Case(
        "length-too-short",
        head(1, 2, 96) + track(FIRST + END, 9) + track(LATE),
        "a track of a wrong length read up to its end, at byte 18",
    ),
    Case(
        "length-too-long",
        head(1, 2, 96) + track(FIRST + END, 20) + track(LATE),
        "a track of a wrong length read up to its end, at byte 18",
    ),
    Case(
        "length-over-two-tracks",
        head(1, 2, 96) + track(FIRST + END, 32) + track(LATE),
        "a track of a wrong length read up to its end, at byte 18",
    ),
    Case(
        "bytes-between-tracks",
        head(1, 2, 96) + track(FIRST + END) + b"\0\0\0" + track(LATE),
        "bytes outside any chunk skipped, at byte 34",
    ),
    Case("bytes-at-the-end", WHOLE + b"\x1a" * 86, "bytes outside any chunk skipped, at byte 42"),
    Case(
        "events-after-the-end",
        song(TUNE + on(0, 71) + off(96, 71)),
        "bytes after the end of a track skipped, at byte 42",
    ),
    Case(
        "empty-track",
        song(TUNE, b"", kind=1),
        "a track without its end read up to the next, at byte 50",
    ),
    Case("unknown-chunk", ONE + chunk(b"XFIH", b"\xff\0") + track(TUNE)),
    Case("format-2", song(FIRST + END, SECOND + END, kind=2)),
    Case("format-2-of-one-track", song(TUNE, kind=2)),
    refused("no-tracks", song(), "has no playable track"),
    refused("nothing-to-play", song(tempo(0, 500_000) + END), "has no playable track"),
)

EVENTS = (
    Case("running-status-after-a-text", song(on(0, 67) + b"\0\xff\1\2la\x60\x43\0" + SECOND + END)),
    Case(
        "running-status-after-sysex", song(on(0, 67) + b"\0\xf0\2\1\xf7\x60\x43\0" + SECOND + END)
    ),
    Case(
        "data-without-status",
        song(b"\0\x43\x50" + b"\x90\x43\x50" + off(96, 67) + SECOND + END),
        "data without a status byte skipped, at byte 23",
    ),
    Case(
        "velocity-above-127", song(on(0, 71, 200) + TUNE), "a damaged message dropped, at byte 22"
    ),
    Case(
        "system-message",
        song(b"\0\xf2\1\2" + b"\0\xf8" + TUNE),
        "a system message, which no file should hold, skipped, 2 times, first at byte 22",
    ),
    Case(
        "number-of-five-bytes",
        song(FIRST + b"\x80\x80\x80\x80\0\x90\x45\x50" + off(96, 69) + END),
        "a number of more than 4 bytes, at byte 30",
    ),
    Case(
        "event-longer-than-its-track",
        song(FIRST + SECOND + b"\0\xff\1\x7fla"),
        "a track ends in the middle of an event, at byte 38",
    ),
    Case(
        "note-without-an-end",
        song(on(0, 67) + LATE),
        "a note without an end stopped at the next one, at byte 22",
    ),
    Case("last-note-without-an-end", song(FIRST + on(0, 69) + b"\x60\xff\x2f\0")),
    Case("end-without-a-note", song(off(0, 71) + TUNE)),
    Case(
        "note-twice", song(on(0, 67) + on(96, 67) + off(96, 67) + END), hears=((0.0, 67), (0.5, 67))
    ),
)

TIMES = (
    Case("tempo-0", song(tempo(0, 0) + TUNE), "a tempo of zero or cut short ignored, at byte 22"),
    Case(
        "tempo-cut-short",
        song(b"\0\xff\x51\2\1\2" + TUNE),
        "a tempo of zero or cut short ignored, at byte 22",
    ),
    Case(
        "time-signature-of-0",
        song(b"\0\xff\x58\4\0\2\x18\x08" + TUNE),
        "an impossible time signature ignored, at byte 22",
    ),
    Case(
        "key-signature-of-8-sharps",
        song(b"\0\xff\x59\2\x08\0" + TUNE),
        "an impossible key signature ignored, at byte 22",
    ),
    Case(
        "long-silence-at-the-end",
        song(FIRST + SECOND + REST + b"\xff\x2f\0"),
        "silence at the end cut to 30 s, at byte 38",
    ),
    refused(
        "absurd-rest",
        song(FIRST + REST + SECOND[1:] + END),
        "the score lasts 388 hours, more than 2: see --max-duration "
        "(most of it is the rest before byte 30)",
    ),
    refused(
        "many-rests",
        song(FIRST + (number(96 * 600) + on(0, 69)[1:]) * 30 + END),
        "the score lasts 2.5 hours, more than 2: see --max-duration",
    ),
    refused(
        "more-than-a-million-events",
        song(on(0, 67) + b"\0\x43\0" * 1_000_000 + END),
        "has more than 1000000 events",
    ),
)

CASES = (*WRAPPED, *HEADERS, *TRACKS, *EVENTS, *TIMES)


def main() -> None:
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    expected = {}
    for case in CASES:
        (folder / f"{case.name}.mid").write_bytes(case.data)
        expected[case.name] = {"notes": case.hears, "says": case.says}
    text = json.dumps(expected, indent=1)
    (folder / "expected.json").write_text(f"{text}\n", encoding="utf-8")


if __name__ == "__main__":
    main()
