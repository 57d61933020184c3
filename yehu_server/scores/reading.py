"""Read a score of any known format, by its first bytes or its ending; or one part of it."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from pkgutil import resolve_name

import numpy as np

from yehu_server.core.midi.channels import PERCUSSION_CHANNEL
from yehu_server.core.player.note_range import YEHU, NoteRange
from yehu_server.errors import ScoreError, one_line
from yehu_server.playing.options import PlayingOptions
from yehu_server.playing.parts import section_size
from yehu_server.playing.stringing import notes_of as range_of
from yehu_server.playing.tuning import RangePolicy
from yehu_server.scores import chosen_parts
from yehu_server.scores.events import NoteColumns, uncollected
from yehu_server.scores.key_switches import with_key_switches, with_low_keys_told, without_low_keys
from yehu_server.scores.rubato import delays_of, midi_delays
from yehu_server.scores.score import (
    MAX_DURATION_H,
    Score,
    check_duration,
    errors_name,
    says_mpe,
    seems_mpe,
)
from yehu_server.scores.smf.reader import read_score
from yehu_server.scores.smf.track import DamagedError
from yehu_server.scores.tune_part import take_turns
from yehu_server.scores.written.in_range import default_parts, moved
from yehu_server.scores.written.notated import Written
from yehu_server.scores.written.performed import leading_notes, performed, shortest_s
from yehu_server.scores.written.tempo import WrittenClock
from yehu_server.util.files import open_regular


def channels_with_notes(scores: Iterable[Score]) -> list[int]:
    """The channels that have notes, counted from 0, in order; percussion is among them."""
    return sorted({each for score in scores for each in score.note_columns.channel.tolist()})


def tracks_with_notes(
    scores: Iterable[Score], channels: Collection[int] = chosen_parts.MELODIC
) -> list[int]:
    """The tracks that have notes on some channels, counted from 1, in order."""
    played = (_on(score, channels) for score in scores)
    return sorted({track for notes in played for track in notes.track.tolist()})


def shares_channels(scores: Iterable[Score]) -> bool:
    """Whether tracks that sound at once have notes on one channel; percussion does not count."""
    own = (_on(score, [channel]) for score in scores for channel in chosen_parts.MELODIC)
    return not all(take_turns(notes.spans(notes.track)) for notes in own)


def _on(score: Score, channels: Collection[int]) -> NoteColumns:
    notes = score.note_columns
    return notes.where(np.isin(notes.channel, [*channels]))


def part_name(scores: Sequence[Score], channel: int | None = None, track: int | None = None) -> str:
    """The name of what a channel or a track plays; its number where it has none of its own."""
    found = {(part.channel, part.track): part.name for score in scores[:1] for part in score.parts}
    numbered = f"channel {channel + 1}" if channel is not None else f"track {track}"
    for (its_channel, its_track), name in found.items():
        if its_channel == channel is not None or its_track == track is not None:
            return name
    if channel is None:
        return numbered
    tracks = {*_on(scores[0], [channel]).track.tolist()}
    return found.get((None, min(tracks)), numbered) if len(tracks) == 1 else numbered


def percussion_notes(scores: Iterable[Score]) -> int:
    """Number of notes on channel 10."""
    return sum(len(_on(score, [PERCUSSION_CHANNEL]).key) for score in scores)


def part_of(score: Score, channel: int | None = None, track: int | None = None) -> Score:
    """The part of a score that one channel and one track have; None means any.

    Messages for all, such as a reset, are in each part. Controllers that a file has in a track
    without notes belong to all tracks that play on their channel.
    """
    events, notes = score.events, score.note_columns
    own = events.channel
    is_kept = (own < 0) | (channel is None) | (own == channel)
    if track is not None:
        is_in_track = events.track == track
        is_silent = ~np.isin(events.track, notes.track)
        is_in_track |= is_silent & np.isin(own, notes.channel[notes.track == track])
        is_kept &= is_in_track | (own < 0)
    return replace(score, events=events.where(is_kept))


MIDI = (".mid", ".midi", ".kar", ".rmi", ".smf")
MUSICXML = (".musicxml", ".xml", ".mxl")
JIANPU = (".jianpu", ".jpu", ".jp", ".txt")
ERSIPU = (".ersipu", ".ersi")
ABC = (".abc",)
MUSESCORE = (".mscz", ".mscx")
WRITTEN = (*MUSICXML, *JIANPU, *ERSIPU, *ABC, *MUSESCORE)
READERS = {  # but for ABC, which has several songs
    "jianpu": "yehu_server.scores.jianpu.reader:read_jianpu",
    "musescore": "yehu_server.scores.musicxml.musescore:read_musescore",
    "musicxml": "yehu_server.scores.musicxml.reader:read_musicxml",
}
ABC_BEGINS = re.compile(rb"^(\xef\xbb\xbf)?(X: *\d|%abc)", re.MULTILINE)
BYTE_ORDER_MARKS = (b"\xef\xbb\xbf", b"\xff\xfe", b"\xfe\xff")


@dataclass(frozen=True)
class ReadOptions:
    """Which parts of a score are played, and in which range."""

    parts: Sequence[str] = ()  # names of the parts to play
    # Whether all are played where none is named: else the one that carries the tune.
    all_parts: bool = False
    in_range: bool = True  # whether parts are moved by octaves as a whole, to fit the instrument
    leaves_low_keys: bool = False  # whether keys far below a tune of a MIDI file are left out
    is_mpe: bool = False  # whether the channels of a MIDI file are notes, and not parts
    is_section: bool = False  # whether several players share the notes of chords
    within: NoteRange = YEHU  # the notes of the instrument
    channels: Collection[int] | None = None  # of a MIDI file that are played: all but percussion
    key_switches: int | None = None  # of a MIDI file: see `Mapping`

    @classmethod
    def by(
        cls, playing: PlayingOptions, parts: Sequence[str] = (), *, all_parts: bool
    ) -> ReadOptions:
        """The options with which a player of some options reads a score."""
        return cls(
            parts,
            all_parts=all_parts,
            in_range=playing.policy is not RangePolicy.CLAMP and playing.tuning.has_octaves,
            leaves_low_keys=playing.policy is RangePolicy.SKIP,
            is_mpe=playing.mapping.mpe,
            is_section=section_size(playing) > 1,
            # In the keys of the score, which the tuning transposes.
            within=range_of(playing.quantities).transposed(-playing.tuning.transposed_by),
            channels=playing.channels,
            key_switches=playing.mapping.key_switches,
        )


DEFAULT = ReadOptions()


def read_any(
    path: str | os.PathLike[str],
    options: ReadOptions = DEFAULT,
    *,
    song: int | None = None,
    strict: bool = False,
    max_duration_h: float = MAX_DURATION_H,
) -> Score:
    """Read a MIDI file, or a written score as it is played.

    `song`, `strict` and `max_duration_h` are as of `smf.read_score`. A written score is one song;
    marks that are not understood are its damage. Raises DamagedError with `strict`: one line naming
    the file and what is first wrong; ScoreError, one line naming the file, where it cannot be read,
    has nothing to play, no part of a name, or lasts too long.
    """
    path = Path(path)
    with uncollected():
        return _read(path, options, song, max_duration_h, strict=strict)


def _read(
    path: Path, options: ReadOptions, song: int | None, max_duration_h: float, *, strict: bool
) -> Score:
    if not is_written(path):
        score = read_score(path, song=song, strict=strict, max_duration_h=max_duration_h)
        with errors_name(path):
            return _midi_played(score, options)
    written = read_written(path, song)
    with errors_name(path):
        clock = WrittenClock(written)
        check_duration(shortest_s(written, clock), max_duration_h)  # before it is performed
        score = performed_part(written, options, clock)
        check_duration(score.duration_s, max_duration_h)
        if strict and score.warnings:
            raise DamagedError(f"{score.warnings[0]}: refused by --strict")
    return replace(score, name=path.stem)


def performed_part(
    written: Written, options: ReadOptions = DEFAULT, clock: WrittenClock | None = None
) -> Score:
    """The parts of a written score that are asked for, as played; raises ScoreError."""
    if options.parts:
        plays = chosen_parts.numbers_of(written.names, options.parts)
    elif options.all_parts:
        plays = [*range(len(written.parts))]
    else:
        plays = default_parts(written, options.within)
    remarks = [*written.remarks, chosen_parts.others_line(written, plays)]
    if options.in_range:
        written, line = moved(written, plays, options.within)
        remarks.append(line)
    remarks = [*filter(None, remarks)]
    clock = clock or WrittenClock(written)
    score = performed(replace(written, remarks=tuple(remarks)), plays, options.within, clock)
    leading = leading_notes(written.parts[next(iter(default_parts(written)), 0)], clock)
    return replace(score, delays=delays_of(leading))


def _midi_played(score: Score, options: ReadOptions) -> Score:
    is_mpe = options.is_mpe or says_mpe(score)
    if not is_mpe and seems_mpe(score):
        line = "each channel has a pressure, as MPE controllers send it: --mpe plays them as one"
        score = replace(score, remarks=(*score.remarks, line))
    played = chosen_parts.MELODIC if options.channels is None else options.channels
    played = range(16) if is_mpe else {*chosen_parts.MELODIC, *played}
    score = with_key_switches(score, options.key_switches, played)
    if not is_mpe:
        treated = without_low_keys if options.leaves_low_keys else with_low_keys_told
        score = treated(score, played, options.within)
    tune = score if is_mpe else chosen_parts.default_midi_part(score)
    delays = midi_delays(score, tune)
    if options.parts:
        score = chosen_parts.parts_chosen(score, options.parts)
    elif len(score.parts) > 1 and not (options.all_parts or is_mpe):
        is_usual = options.within == YEHU
        score = tune if is_usual else chosen_parts.default_midi_part(score, options.within)
    if not len(score.note_columns.key):
        line = "has controllers and no note: nothing sounds"
        score = replace(score, remarks=(*score.remarks, line))
    elif options.in_range:
        score = chosen_parts.midi_in_range(
            score,
            range(16) if is_mpe else options.channels,
            is_mpe=is_mpe,
            is_section=options.is_section,
            within=options.within,
        )
    return replace(score, delays=delays)


def read_written(path: Path, song: int | None = None) -> Written:
    """Read a written score: MusicXML, jianpu, two-four notation, or a tune of a file of ABC.

    Raises ScoreError, one line naming the file, where it cannot be read or is none of these.
    """
    form = format_of(path)
    if song not in (None, 1) and form != "abc":
        raise ScoreError(f"{one_line(str(path))}: has 1 song")
    if form == "abc":
        from yehu_server.scores.abc.reader import read_abc

        return read_abc(path, song)
    if form in READERS:
        read: Callable[[Path], Written] = resolve_name(READERS[form])
        return read(path)
    reason = f"is not a written score: it is not XML, nor named {', '.join(WRITTEN)}"
    if form == "humdrum":
        reason = "is humdrum (**kern), which is not read; convert it to MusicXML, as Verovio does"
    raise ScoreError(f"{one_line(str(path))}: {reason}")


def is_written(path: Path) -> bool:
    """Whether a file is a written score, and not a MIDI file; its bytes go before its name."""
    return format_of(path) not in ("midi", "")


def format_of(path: Path) -> str:
    """The format of a score by its first bytes and its ending; empty for others."""
    data, ending = beginning_of(path), path.suffix.lower()
    if data.startswith((b"MThd", b"RIFF")) or ending in MIDI:
        return "midi"
    if ending in ABC or ABC_BEGINS.search(data):
        return "abc"
    if ending in (*JIANPU, *ERSIPU):
        return "jianpu"
    if ending in MUSICXML or (ending not in MUSESCORE and _is_xml(data)):
        return "musicxml"
    if ending in MUSESCORE:
        return "musescore"
    return "humdrum" if ending == ".krn" or data.startswith((b"**", b"!!!")) else ""


def is_capture(path: Path) -> bool:
    """Whether a file is the capture of a session."""
    return beginning_of(path).lstrip().startswith(b"{")


def beginning_of(path: Path) -> bytes:
    """The first bytes of a file; none where it cannot be read."""
    try:
        with open_regular(path) as file:
            return file.read(64)
    except (OSError, ValueError):  # the reader reports it
        return b""


def _is_xml(data: bytes) -> bool:
    """Whether the beginning of a file is that of XML, in any encoding."""
    for mark in BYTE_ORDER_MARKS:
        data = data.removeprefix(mark)
    return data.replace(b"\0", b"").lstrip().startswith(b"<")
