"""What several programs read in a score, in one form: for `compare_scores`."""

from __future__ import annotations

import re
from bisect import bisect_right
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from typing import Any

import mido

from yehu_server.core.midi.channels import PERCUSSION
from yehu_server.scores.written.layout import page_bars
from yehu_server.scores.written.notated import Note, Part, Written

# In MIDI files: what is nearer counts as one place; parts of a quarter.
GRID = 48
# A bar that another program has elsewhere is found where so much of its notes agrees.
ENOUGH = 0.5
# Notes of which a MIDI file has several, or elsewhere, as each program likes to play them.
PLAYED_OUT = {
    "trill", "mordent", "inverted-mordent", "turn", "inverted-turn", "tremolo", "arpeggio",
    "glissando", "portamento",
}  # fmt: skip
AROUND = 3  # semitones from such a note to those of its ornament
# Marks by which each program makes notes shorter or longer as it likes.
SHORTENED = {
    "staccato", "staccatissimo", "spiccato", "portato", "marcato", "accent", "tenuto", "fermata",
    "breath", "soft-accent",
}  # fmt: skip


@dataclass(frozen=True)
class Heard:
    """A note in its bar: the bar by its place as played, and by its number."""

    bar: int
    number: str
    offset: Fraction  # quarters
    length: Fraction
    pitch: float


@dataclass
class Reading:
    """All notes of a score, of all parts, and the numbers of its bars as played."""

    notes: list[Heard] = field(default_factory=list)
    bars: list[str] = field(default_factory=list)
    is_unfolded: bool = True
    is_together: bool = True  # all parts begin their bars at the same beats
    moved: int = 0  # bars from which on a MIDI file is earlier or later
    left_out: int = 0  # notes that are not compared
    beside: int = 0  # notes in bars that it alone plays


def read_by_music21(path: Path) -> Reading:
    """What music21 reads."""
    import music21  # type: ignore[import-not-found, unused-ignore]

    parsed: Any = music21.converter.parse(path)
    found = Reading()
    begun: set[tuple[Fraction, ...]] = set()
    for part in parsed.toSoundingPitch().parts:
        try:
            unfolded = part.expandRepeats()
        except music21.repeat.ExpanderException:
            unfolded, found.is_unfolded = part, False
        measures = list(unfolded.getElementsByClass("Measure"))
        begins = [_exact(measure.offset) for measure in measures]
        found.bars = [str(measure.number) for measure in measures]
        begun.add(tuple(begins))
        for each in unfolded.stripTies().flatten().notes:
            if each.duration.isGrace or isinstance(each, music21.harmony.ChordSymbol):
                continue
            if pitches := getattr(each, "pitches", ()):
                pitch = max(float(pitch.ps) for pitch in pitches)
                length = _exact(each.quarterLength)
                found.notes.append(_heard(begins, found.bars, _exact(each.offset), length, pitch))
    found.is_together = len(begun) <= 1
    return found


def read_by_us(written: Written) -> Reading:
    """The same by our own reader."""
    begins = [bar.beat for bar in written.bars]
    numbers = [_number(bar.number) for bar in written.bars]
    notes = [
        _heard(begins, numbers, note.beat, note.length, note.pitch)
        for part in written.parts
        for note in part.notes
    ]
    return Reading(notes, numbers)


def _number(text: str) -> str:
    """The number of a bar as music21 has it: without the letter of one that a line divides."""
    found = re.match(r"\d+", text)
    return found[0] if found else text


def _heard(
    begins: list[Fraction], numbers: list[str], beat: Fraction, length: Fraction, pitch: float
) -> Heard:
    at = max(bisect_right(begins, _exact(beat)) - 1, 0)
    offset = _exact(beat) - (begins[at] if begins else 0)
    return Heard(at, numbers[at] if numbers else "", _exact(offset), _exact(length), pitch)


def _exact(value: Any) -> Fraction:
    return Fraction(value).limit_denominator(10_000)


@dataclass(frozen=True)
class _Ornament:
    """Where and how high a note is played out, in parts of a quarter on our own axis."""

    begin: int
    end: int
    lowest: float
    highest: float

    def has(self, tick: int, key: float) -> bool:
        return self.begin <= tick < self.end and self.lowest <= key <= self.highest


def read_by_midi(path: Path, written: Written) -> tuple[Reading, Reading]:
    """What we read of a score, and what another program does, by the MIDI file that it wrote.

    A MIDI file has no bars: its notes are placed into ours. From a bar on that the other program
    has longer or shorter, or plays again, its notes are found by their pitches. Of what it strikes
    at once in a track the highest counts, and what we have. Notes with grace notes or ornaments are
    left out, and so is how long notes with articulations are.
    """
    bars = page_bars(written)
    begins = [_tick(bar.begin) for bar in bars]
    own: list[tuple[int, float, int]] = []  # where, pitch, length: 0 where that does not count
    ornaments: list[_Ornament] = []
    for part in written.parts:
        for note in part.notes:
            tick, length = _tick(note.beat), _tick(note.end) - _tick(note.beat)
            if _is_played_out(note, part):
                pitches = [each.pitch for each in (*note.before, *note.after)] + [note.pitch]
                begin = tick - GRID if note.before else tick
                end = tick + max(length, 1)
                low, high = min(pitches) - AROUND, max(pitches) + AROUND
                ornaments.append(_Ornament(begin, end, low, high))
            else:
                is_short = any(mark.name in SHORTENED for mark in note.marks)
                own.append((tick, note.pitch, 0 if is_short else length))
    theirs = _struck(path)
    shifts = _shifts(begins, own, {(tick, key) for track in theirs for tick, key, _ in track})
    where = [begin + shift for begin, shift in zip(begins, shifts, strict=True)]
    for at in range(1, len(where)):
        where[at] = max(where[at], where[at - 1])
    places = {(tick, pitch) for tick, pitch, _ in own}
    free = {(tick, pitch) for tick, pitch, length in own if not length}
    ends = [_tick(bar.end) for bar in bars]
    found: dict[tuple[int, float], int] = {}
    beside = 0
    for track in theirs:
        highest: dict[int, float] = {}
        for tick, key, _ in track:
            highest[tick] = max(highest.get(tick, 0.0), key)
        for tick, key, length in track:
            at = max(bisect_right(where, tick) - 1, 0)
            moved = tick - shifts[at]
            if moved >= ends[at]:
                beside += 1
            elif (moved, key) in places or (
                key == highest[tick] and not any(each.has(moved, key) for each in ornaments)
            ):
                is_free = (moved, key) in free
                found[moved, key] = 0 if is_free else max(length, found.get((moved, key), 0))
    numbers = [_number(bar.number) for bar in bars]
    beats = [bar.begin for bar in bars]

    def heard(notes: Any) -> Reading:
        made = [
            _heard(beats, numbers, Fraction(tick, GRID), Fraction(length, GRID), key)
            for (tick, key), length in notes.items()
        ]
        return Reading(made, numbers)

    ours: dict[tuple[int, float], int] = {}
    for tick, pitch, length in own:  # unisons of several parts are one
        ours[tick, pitch] = 0 if (tick, pitch) in free else max(length, ours.get((tick, pitch), 0))
    moved_bars = sum(one != other for one, other in pairwise([0, *shifts]))
    other = heard(found)
    other.moved, other.beside, other.left_out = moved_bars, beside, len(ornaments)
    return heard(ours), other


def _tick(beat: Fraction) -> int:
    return round(beat * GRID)


def _is_played_out(note: Note, part: Part) -> bool:
    return bool(
        note.before
        or note.after
        or any(mark.name in PLAYED_OUT for mark in note.marks)
        or any(s.name in PLAYED_OUT and s.begin <= note.beat < s.end for s in part.spans)
    )


def _struck(path: Path) -> list[list[tuple[int, float, int]]]:
    """The notes of each track of a MIDI file: where, how high, how long; parts of a quarter."""
    file = mido.MidiFile(path)
    found = []
    for track in file.tracks:
        now = 0
        held: dict[tuple[int, int], int] = {}
        notes: list[tuple[int, float, int]] = []
        for message in track:
            now += message.time
            if message.type not in ("note_on", "note_off") or message.channel == PERCUSSION:
                continue
            key = (message.channel, message.note)
            if key in held:
                begin = held.pop(key)
                ends = [round(Fraction(each * GRID, file.ticks_per_beat)) for each in (begin, now)]
                notes.append((ends[0], float(message.note), ends[1] - ends[0]))
            if message.type == "note_on" and message.velocity > 0:
                held[key] = now
        found.append(notes)
    return found


def _shifts(
    begins: Sequence[int],
    own: Sequence[tuple[int, float, int]],
    theirs: set[tuple[int, float]],
) -> list[int]:
    """By how much later each bar is in theirs."""
    by_bar: dict[int, set[tuple[int, float]]] = defaultdict(set)
    for tick, pitch, _ in own:
        by_bar[max(bisect_right(begins, tick) - 1, 0)].add((tick, pitch))
    by_pitch: dict[float, list[int]] = defaultdict(list)
    for tick, pitch in theirs:
        by_pitch[pitch].append(tick)
    found: list[int] = []
    shift = 0
    for at in range(len(begins)):
        notes = by_bar[at]

        def same(by: int, notes: set[tuple[int, float]] = notes) -> int:
            return sum((tick + by, pitch) in theirs for tick, pitch in notes)

        if same(shift) < ENOUGH * len(notes):
            tried = {there - tick for tick, pitch in notes for there in by_pitch[pitch]}
            best = max(tried, key=lambda by: (same(by), -abs(by - shift)), default=shift)
            if same(best) >= ENOUGH * len(notes):
                shift = best
        found.append(shift)
    return found
