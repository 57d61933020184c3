"""Read a score of any kind that is known: by its first bytes, else by its ending."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from yehu_server.errors import ScoreError
from yehu_server.files import read_bytes
from yehu_server.lines import one_line
from yehu_server.score.duration import MAX_DURATION_H, check_duration
from yehu_server.score.score import Score
from yehu_server.score.smf.faults import DamagedError
from yehu_server.score.smf.reader import read_score
from yehu_server.score.written.notated import Written
from yehu_server.score.written.performed import performed

MIDI = (".mid", ".midi", ".kar", ".rmi", ".smf")
MUSICXML = (".musicxml", ".xml", ".mxl")
JIANPU = (".jianpu", ".jpu", ".txt")
ERSIPU = (".ersipu", ".ersi")
WRITTEN = (*MUSICXML, *JIANPU, *ERSIPU)
MIDI_BEGINNINGS = (b"MThd", b"RIFF")
XML = b"<"
BYTE_ORDER_MARKS = (b"\xef\xbb\xbf", b"\xff\xfe", b"\xfe\xff")


def read_any(
    path: str | os.PathLike[str],
    *,
    song: int | None = None,
    strict: bool = False,
    max_duration_h: float = MAX_DURATION_H,
) -> Score:
    """Read a MIDI file, or a written score as it is played.

    Parameters
    ----------
    song, strict, max_duration_h
        As `smf.read_score` has them. A written score is one song; marks that are not understood
        are its damage.

    Raises
    ------
    DamagedError
        With `strict`: one line naming the file and what is first wrong.
    ScoreError
        One line naming the file, where it cannot be read, has nothing to play or lasts too long.
    """
    path = Path(path)
    if not is_written(path):
        return read_score(path, song=song, strict=strict, max_duration_h=max_duration_h)
    written = read_written(path)
    with naming(path):
        if song not in (None, 1):
            raise ScoreError("has 1 song")
        score = performed(written)
        check_duration(score.duration_s, max_duration_h)
        if strict and score.warnings:
            raise DamagedError(f"{score.warnings[0]}: refused by --strict")
    return replace(score, name=path.stem)


def read_written(path: Path) -> Written:
    """Read a written score: MusicXML, jianpu or two-four notation.

    Raises
    ------
    ScoreError
        One line naming the file, where it cannot be read or is none of these.
    """
    kind = path.suffix.lower()
    if kind in ERSIPU:
        from yehu_server.score.jianpu.ersipu import read_ersipu

        return read_ersipu(path)
    if kind in JIANPU:
        from yehu_server.score.jianpu.reader import read_jianpu

        return read_jianpu(path)
    if kind in MUSICXML or _is_xml(_beginning(path)):
        from yehu_server.score.musicxml.reader import read_musicxml

        return read_musicxml(path)
    endings = ", ".join(WRITTEN)
    raise ScoreError(
        f"{one_line(str(path))}: is no written score: it is no XML, nor named {endings}"
    )


def is_written(path: Path) -> bool:
    """Whether a file is a written score, and not a MIDI file; its bytes go before its name."""
    data = _beginning(path)
    if data.startswith(MIDI_BEGINNINGS):
        return False
    kind = path.suffix.lower()
    return kind in WRITTEN or (kind not in MIDI and _is_xml(data))


@contextlib.contextmanager
def naming(path: Path) -> Iterator[None]:
    """Let errors about a score name its file."""
    try:
        yield
    except ScoreError as error:
        raise type(error)(f"{one_line(str(path))}: {error}") from None


def _beginning(path: Path) -> bytes:
    try:
        return read_bytes(path)[:64]
    except (OSError, ValueError):  # the reader tells what is wrong
        return b""


def _is_xml(data: bytes) -> bool:
    """Whether the beginning of a file is that of XML, in any encoding."""
    for mark in BYTE_ORDER_MARKS:
        data = data.removeprefix(mark)
    return data.replace(b"\0", b"").lstrip().startswith(XML)
