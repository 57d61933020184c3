"""Read a score of any kind that is known, by its first bytes or its ending, or one part of it."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from pathlib import Path

from yehu_server.core.midi.channels import PERCUSSION
from yehu_server.errors import ScoreError, one_line
from yehu_server.scores.score import MAX_DURATION_H, Score, ScoreEvent, check_duration, naming
from yehu_server.scores.smf.faults import DamagedError
from yehu_server.scores.smf.reader import read_score
from yehu_server.scores.written.notated import Written
from yehu_server.scores.written.performed import performed
from yehu_server.util.files import read_bytes


def channels_with_notes(scores: Iterable[Score]) -> list[int]:
    """The channels that have notes, counted from 0, in order; percussion is among them."""
    return sorted({event.message.channel for event in _notes(scores)})


def tracks_with_notes(scores: Iterable[Score]) -> list[int]:
    """The tracks that have notes, counted from 1, in order; percussion does not count."""
    notes = (event for event in _notes(scores) if event.message.channel != PERCUSSION)
    return sorted({event.track for event in notes})


def percussion_notes(scores: Iterable[Score]) -> int:
    """How many notes channel 10 has."""
    return sum(event.message.channel == PERCUSSION for event in _notes(scores))


def part_of(score: Score, channel: int | None = None, track: int | None = None) -> Score:
    """The part of a score that one channel and one track have; None means any.

    What moves all, such as a reset, is in each part. Controllers that a file has in a track
    without notes belong to all tracks that play on their channel.
    """
    keeps: list[Callable[[ScoreEvent], bool]] = []
    if channel is not None:
        keeps.append(lambda event: _channel(event) in (channel, None))
    if track is not None:
        silent = {event.track for event in score.events} - {e.track for e in _notes([score])}
        on = {_channel(event) for event in _notes([score]) if event.track == track}
        keeps.append(
            lambda event: (
                event.track == track
                or _channel(event) is None
                or (event.track in silent and _channel(event) in on)
            )
        )
    events = (event for event in score.events if all(keep(event) for keep in keeps))
    return replace(score, events=tuple(events))


def has_notes(scores: Sequence[Score]) -> bool:
    """Whether there is a note in some scores."""
    return any(True for _ in _notes(scores))


def _notes(scores: Iterable[Score]) -> Iterable[ScoreEvent]:
    for score in scores:
        for event in score.events:
            if event.message.type == "note_on" and event.message.velocity > 0:
                yield event


def _channel(event: ScoreEvent) -> int | None:
    return getattr(event.message, "channel", None)


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
    if kind in (*JIANPU, *ERSIPU):
        from yehu_server.scores.jianpu.reader import read_jianpu

        return read_jianpu(path)
    if kind in MUSICXML or _is_xml(_beginning(path)):
        from yehu_server.scores.musicxml.reader import read_musicxml

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
