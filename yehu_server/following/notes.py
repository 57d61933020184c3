"""Find strokes and notes in an analysed recording: where a bow would change, and where a finger."""

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from yehu_server.following.frames import FLUX_FRAMES, HOP_S
from yehu_server.following.heard import Heard

Array = Any

A4_HZ = 440.0
SHORTEST_S = 0.045  # of a stroke, or of a note in it
BRIDGED_S = 0.02  # the longest gap in a pitch that is filled
# A note that moves one way by so much (semitones), and lasts no longer, is a part of a slide.
PASSING, PASSING_S, ONE_WAY = 0.6, 0.2, 0.8
# A new stroke: the level rises by so much, and the mean of all bands, in so short a time; and had
# fallen before.
RISE_DB, FALL_DB, FLUX_DB, RISE_S, FALL_S = 5.0, 2.0, 2.2, 0.06, 0.15
# Where the clarity falls by less than this, as with a vibrato, the rise of all bands must be more.
CLARITY_FALL, CLEAR_FLUX_DB = 0.15, 4.0
# Cost of a frame of a note, by the distance of its pitch (semitones), and of another note.
SPREAD, FARTHEST, STEP = 0.35, 6.0, 15.0
AT_NOTE = 0.3  # semitones from the middle of a note, within which a pitch belongs to it
SMOOTHED, STEADY = 36, 0.01  # frames; semitones a frame
SLIDE_S = 0.075  # between two notes for longer, and it is a slide
# An attack ends so far below the highest level within this time.
ATTACK_DB, ATTACK_WITHIN_S = 3.0, 0.25


@dataclass(frozen=True)
class HeardNote:
    """A note: frames from `start` to before `end`, and its pitch (fractional MIDI note).

    `is_slide` where the pitch slides to it from the note before, in one stroke.
    """

    start: int
    end: int
    pitch: float
    is_slide: bool = False


@dataclass(frozen=True)
class Stroke:
    """Notes that sound without a new attack."""

    notes: tuple[HeardNote, ...]
    pitch: Array  # [shape=(frames,)] of each of its frames (fractional MIDI note)
    attack_s: float  # duration of the attack

    @property
    def start(self) -> int:
        """Its first frame."""
        return self.notes[0].start

    @property
    def end(self) -> int:
        """The frame after its last."""
        return self.notes[-1].end


def midi_of(hz: Array) -> Array:
    """Frequencies as fractional MIDI notes."""
    return 69.0 + 12.0 * np.log2(np.asarray(hz) / A4_HZ)


def strokes_of(heard: Heard) -> list[Stroke]:
    """Find the strokes of a recording, in order."""
    pitch = midi_of(heard.pitch_hz)
    runs = [run for run in _runs(heard.is_voiced) if run[1] - run[0] > SHORTEST_S / HOP_S]
    for start, end in runs:
        known = start + np.flatnonzero(np.isfinite(pitch[start:end]))
        pitch[start:end] = np.interp(np.arange(start, end), known, pitch[known])
    offset = _offset([pitch[start:end] for start, end in runs])
    strokes = []
    for start, end in runs:
        for first, last in pairwise([start, *_new_strokes(heard, start, end), end]):
            notes = _notes(pitch[first:last], first, offset)
            near = heard.level_db[first : min(last, first + round(ATTACK_WITHIN_S / HOP_S))]
            attack_s = float(np.argmax(near >= near.max() - ATTACK_DB) * HOP_S)
            strokes.append(Stroke(notes, pitch[first:last], attack_s))
    return strokes


def _runs(is_voiced: Array) -> list[tuple[int, int]]:
    """Beginnings and ends of what is voiced; short gaps are bridged."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], is_voiced.astype(np.int8), [0]))))
    runs: list[tuple[int, int]] = []
    for start, end in zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True):
        if runs and (start - runs[-1][1]) * HOP_S <= BRIDGED_S:
            runs[-1] = runs[-1][0], end
        else:
            runs.append((start, end))
    return runs


def _offset(pitches: list[Array]) -> float:
    """The mean distance (semitones) of a voice from the nearest notes of equal temperament."""
    if not pitches:
        return 0.0
    turns = 0.0j
    for pitch in pitches:
        size = min(SMOOTHED, len(pitch))  # without its vibrato
        smooth = np.convolve(pitch, np.full(size, 1.0 / size), "valid")
        steady = smooth[np.abs(np.gradient(smooth)) < STEADY] if len(smooth) > 1 else smooth
        turns += np.exp(2j * np.pi * steady).sum()
    return float(np.angle(turns) / (2.0 * np.pi)) if turns else 0.0


def _new_strokes(heard: Heard, start: int, end: int) -> list[int]:
    """The frames of a run at which a new stroke begins."""
    level, flux, clarity = (
        each[start:end] for each in (heard.level_db, heard.flux_db, heard.clarity)
    )
    typical = float(np.median(clarity))
    rise, fall = round(RISE_S / HOP_S), round(FALL_S / HOP_S)
    found: list[int] = []
    at = rise // 2
    while at < len(level) - rise // 2:
        is_peak = flux[at] == flux[max(at - rise, 0) : at + rise + 1].max()
        if is_peak and flux[at] >= FLUX_DB:
            before = level[max(at - rise, 0) : at + 1]
            low = max(at - rise, 0) + int(np.argmin(before))
            gained = level[at : at + rise].max() - level[low]
            lost = level[max(low - fall, 0) : low + 1].max() - level[low]
            near = slice(max(low - FLUX_FRAMES, 0), at + FLUX_FRAMES)
            goes_on = typical - clarity[near].min() < CLARITY_FALL and flux[at] < CLEAR_FLUX_DB
            if gained >= RISE_DB and lost >= FALL_DB and not goes_on:
                found.append(start + at)
                at += rise
        at += 1
    return found


def _notes(pitch: Array, first: int, offset: float) -> tuple[HeardNote, ...]:
    """The notes of a stroke with these pitches, whose first frame is number `first`."""
    lowest = int(np.floor(pitch.min() - offset))
    states = np.arange(lowest, int(np.ceil(pitch.max() - offset)) + 1) + offset
    distance = np.square((pitch[:, None] - states) / SPREAD)
    cost = np.minimum(0.5 * distance, FARTHEST)
    path = _cheapest_path(cost)
    borders = [0, *(np.flatnonzero(np.diff(path)) + 1).tolist(), len(pitch)]
    borders = _without_short(borders, pitch)
    notes: list[HeardNote] = []
    was_passing = False
    for start, end in pairwise(borders):
        middle = float(np.median(pitch[start:end]))
        is_passing = _is_passing(pitch[start:end])
        is_slide = is_passing or was_passing
        is_slide = is_slide or (start > 0 and _is_slide(pitch, start, notes[-1].pitch, middle))
        notes.append(HeardNote(first + start, first + end, middle, bool(notes) and is_slide))
        was_passing = is_passing
    return tuple(notes)


def _is_passing(pitch: Array) -> bool:
    """Whether a note is rather a part of a slide."""
    span = float(np.ptp(pitch))
    is_one_way = abs(float(pitch[-1] - pitch[0])) > ONE_WAY * span
    return span > PASSING and is_one_way and len(pitch) * HOP_S < PASSING_S


def _cheapest_path(cost: Array) -> Array:
    """The cheapest path through states, where each change costs STEP."""
    frames, states = cost.shape
    previous = np.zeros((frames, states), np.int32)
    best, own = cost[0], np.arange(states)
    for at in range(1, frames):
        other = int(best.argmin())
        changes = best[other] + STEP < best
        previous[at] = np.where(changes, other, own)
        best = np.where(changes, best[other] + STEP, best) + cost[at]
    path = np.zeros(frames, np.int64)
    path[-1] = best.argmin()
    for at in range(frames - 1, 0, -1):
        path[at - 1] = previous[at, path[at]]
    return path


def _without_short(borders: list[int], pitch: Array) -> list[int]:
    """Borders of notes, where each that is too short is joined to the nearer neighbour."""
    shortest = SHORTEST_S / HOP_S
    while len(borders) > 2:
        lengths = np.diff(borders)
        place = int(np.argmin(lengths))
        if lengths[place] >= shortest:
            break
        middles = [float(np.median(pitch[start:end])) for start, end in pairwise(borders)]
        left = abs(middles[place] - middles[place - 1]) if place > 0 else np.inf
        right = abs(middles[place] - middles[place + 1]) if place + 1 < len(middles) else np.inf
        del borders[place if left <= right else place + 1]
    return borders


def _is_slide(pitch: Array, border: int, before: float, after: float) -> bool:
    """Whether the pitch takes long from one note to the next, about a border."""
    reach = round(0.3 / HOP_S)
    near = pitch[max(border - reach, 0) : border]
    left = np.flatnonzero(np.abs(near - before) < AT_NOTE)
    then = pitch[border : border + reach]
    arrived = np.flatnonzero(np.abs(then - after) < AT_NOTE)
    if len(left) == 0 or len(arrived) == 0:
        return True
    return bool((len(near) - left[-1] + arrived[0]) * HOP_S > SLIDE_S)
