"""Make a performance of an analysed recording: notes, bends and dynamics, as a score's events.

The player does the rest: which string and finger, how the bow is drawn so that the string speaks.
"""

import math
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import mido
import numpy as np

from yehu_server.core.player.fingering import OPEN_WITHIN
from yehu_server.core.player.note_range import YEHU, NoteRange
from yehu_server.core.voice.note_detection import dynamics_of
from yehu_server.errors import ScoreError
from yehu_server.following.frames import HOP_S
from yehu_server.following.heard import Heard
from yehu_server.following.notes import A4_HZ, AT_NOTE, SLIDE_S, HeardNote, Stroke
from yehu_server.playing.options import STILL_HANDS
from yehu_server.playing.tuning import EQUAL, KEYS, STANDARD_A4, Tuning
from yehu_server.scores.events import BEND, Events, ScoreEvent, Setting
from yehu_server.scores.score import Score
from yehu_server.scores.written.mark_settings import ATTACK, INNER, STRING

Array = Any

DYNAMICS = "/playing/dynamics"
# A note about the open outer string that is not within so many semitones for this share of its time
# is not played on it.
STILL, MOSTLY = 0.12, 0.8
QUARTER_S = 0.5  # of the score
VELOCITY = 80  # neutral: loudness is in the dynamics
LOUD_SHARE = 0.98  # of the voiced frames: the level of full dynamics
STEP_FRAMES = 2  # between two bends
NEAR_CENTS, NEAR_DB = 1.5, 0.4  # smaller changes are not sent
SHORTEST_ATTACK_MS, LONGEST_ATTACK_MS, DEFAULT_ATTACK_MS = 12.0, 200.0, 40.0
# Events come so much earlier, since the finger slides for 8 ms and the string follows. Measured by
# round trips (bench/following.py).
DELAY_MS = 10.0


@dataclass(frozen=True)
class Style:
    """Shares, 0 to 1, of the differences in loudness and of the attacks that are played."""

    loudness: float = 1.0
    attacks: float = 1.0


STYLES = {"exact": Style(1.0, 1.0), "gentle": Style(0.6, 0.4), "even": Style(0.0, 0.0)}


@dataclass(frozen=True)
class FollowOptions:
    """Options of how a recording is played."""

    transpose: float | None = None  # semitones; None: by octaves into the range of the instrument
    correct: float = 0.0  # how far notes are moved to the tuning, 0 to 1
    # Whether a correction only moves notes; else it also narrows their vibrato and slides.
    keeps_vibrato: bool = False
    style: Style = field(default_factory=Style)
    tuning: Tuning = EQUAL
    a4: float = STANDARD_A4  # Hz
    within: NoteRange = YEHU  # the notes of the instrument


@dataclass(frozen=True)
class Performed:
    """The score of a performance, and what was done to fit the instrument."""

    score: Score
    semitones: float  # by which all of it is transposed
    notes: int
    strokes: int
    notes_moved: int  # by further octaves


def performed(heard: Heard, strokes: list[Stroke], options: FollowOptions) -> Performed:
    """Make a performance of a recording. Raises ScoreError where there is no note in it."""
    notes = [note for stroke in strokes for note in stroke.notes]
    if not notes:
        raise ScoreError(f"{heard.name}: there is no note in it")
    sharper = 12.0 * math.log2(A4_HZ / options.a4)
    semitones = options.transpose
    if semitones is None:
        semitones = _octaves(notes, sharper, options.within)
    builder = _Builder(heard, options, sharper + semitones)
    for address, value in STILL_HANDS.items():
        builder.set(0, address, value)
    for stroke in strokes:
        builder.add(stroke)
    events = sorted(builder.events, key=lambda each: each.time_s)
    duration = max(heard.duration_s, events[-1].time_s)
    name = heard.name.rpartition("/")[2].rpartition(".")[0] or heard.name
    score = Score(Events.of(events), duration, name, heard.warnings)
    return Performed(score, semitones, len(notes), len(strokes), builder.moved)


def _octaves(notes: list[HeardNote], sharper: float, within: NoteRange) -> float:
    """The octaves (semitones) by which most of the notes come into range, as few as can be."""
    pitches = np.array([note.pitch for note in notes]) + sharper
    lengths = np.array([note.end - note.start for note in notes], np.float64)
    choices = sorted(range(-60, 61, 12), key=abs)
    lowest, highest = within.lowest - 0.5, within.highest + 0.5
    is_in_range = [(pitches > lowest - shift) & (pitches < highest - shift) for shift in choices]
    share = [lengths[each].sum() for each in is_in_range]
    return float(choices[int(np.argmax(share))])


class _Builder:
    """Collects the events of strokes."""

    def __init__(self, heard: Heard, options: FollowOptions, shift: float) -> None:
        self.events: list[ScoreEvent] = []
        self.moved = 0
        self._is_inner = False
        self._options, self._shift = options, shift
        voiced = heard.level_db[heard.is_voiced]
        full = float(np.quantile(voiced, LOUD_SHARE)) if len(voiced) else 0.0
        self._dynamics = dynamics_of(
            options.style.loudness * np.minimum(heard.level_db - full, 0.0)
        )
        tuned = ((key, options.tuning.pitch(key, options.a4)) for key in KEYS)
        mapped = [(key, pitch) for key, pitch in tuned if pitch is not None]
        self._keys = [key for key, _ in mapped]
        self._pitches = np.array([pitch for _, pitch in mapped])

    def add(self, stroke: Stroke) -> None:
        """Add a stroke."""
        pitch = self._played(stroke)
        attack_ms = self._attack_ms(stroke)
        attack = round(1e-3 * attack_ms / HOP_S)
        first = stroke.start
        self.set(first, ATTACK, attack_ms)
        levels = self._dynamics[first : stroke.end].copy()
        levels[:attack] = levels[: attack + 1].max()
        held = -1
        groups = _groups(stroke.notes)
        at_level = math.nan
        for start, end in groups:
            part = pitch[start - first : end - first]
            key, of_key = self._key(float(np.median(part)))
            self._choose_string(start, part)
            at_bend = math.nan
            for frame in range(start, end):
                place = frame - first
                level = float(levels[place])
                if not abs(20.0 * math.log10(level / at_level)) < NEAR_DB:
                    self.set(frame, DYNAMICS, level)
                    at_level = level
                bend = float(part[frame - start]) - of_key
                is_due = (frame - start) % STEP_FRAMES == 0
                if not (abs(bend - at_bend) < NEAR_CENTS / 100.0) and is_due:
                    self.set(frame, BEND, bend)
                    at_bend = bend
                if frame == start and key != held:
                    self._send(frame, "note_on", key)
                    if held >= 0:
                        self._send(frame, "note_off", held)
                    held = key
        self._send(stroke.end, "note_off", held)

    def _choose_string(self, frame: int, pitch: Array) -> None:
        """Set the inner string where the open outer one could not follow a pitch."""
        within = self._options.within
        off = np.abs(pitch - within.open_notes[1])
        is_about = off.min() < OPEN_WITHIN and pitch.max() <= within.highest_notes[0]
        is_inner = bool(is_about and np.quantile(off[off < OPEN_WITHIN], MOSTLY) > STILL)
        if is_inner != self._is_inner:
            self.set(frame, STRING, INNER if is_inner else None)
            self._is_inner = is_inner

    def _played(self, stroke: Stroke) -> Array:
        """The pitch of each frame of a stroke as it is played."""
        pitch = _stepped(stroke) + self._shift
        first = stroke.start
        middles, moves, keep = [], [], self._options.keeps_vibrato
        correct = self._options.correct
        for note in stroke.notes:
            part = slice(note.start - first, note.end - first)
            octaves = self._fit(note.pitch + self._shift)
            _, tuned = self._key(note.pitch + self._shift)
            if not keep:
                pitch[part] += correct * (note.pitch + self._shift - pitch[part])
            middles.append(0.5 * (note.start + note.end) - first)
            moves.append(correct * (tuned - note.pitch - self._shift))
            pitch[part] += octaves
        pitch += np.interp(np.arange(len(pitch)), middles, moves)
        return np.clip(pitch, *self._options.within.ends)

    def _fit(self, pitch: float) -> float:
        """The octaves (semitones) that bring a note into range."""
        octaves, (lowest, highest) = 0.0, self._options.within.ends
        while pitch + octaves <= lowest - 0.5:
            octaves += 12.0
        while pitch + octaves >= highest + 0.5:
            octaves -= 12.0
        self.moved += octaves != 0.0
        return octaves

    def _key(self, pitch: float) -> tuple[int, float]:
        """The key that is nearest to a pitch, and its own pitch."""
        place = int(np.abs(self._pitches - pitch).argmin())
        return self._keys[place], float(self._pitches[place])

    def _attack_ms(self, stroke: Stroke) -> float:
        share = self._options.style.attacks
        heard = min(max(1e3 * stroke.attack_s, SHORTEST_ATTACK_MS), LONGEST_ATTACK_MS)
        return float(DEFAULT_ATTACK_MS * (heard / DEFAULT_ATTACK_MS) ** share)

    def set(self, frame: int, address: str, value: float | None) -> None:
        """Set a parameter at a frame."""
        self._add(frame, Setting(address, value))

    def _send(self, frame: int, kind: str, key: int) -> None:
        velocity = VELOCITY if kind == "note_on" else 64
        self._add(frame, mido.Message(kind, note=key, velocity=velocity))

    def _add(self, frame: int, message: Any) -> None:
        time_s = max(frame * HOP_S - 1e-3 * DELAY_MS, 0.0)
        self.events.append(ScoreEvent(time_s, message, time_s / QUARTER_S))


def _stepped(stroke: Stroke) -> Array:
    """The pitch of a stroke, where short transitions of a voice become steps of the fingers."""
    pitch, reach = stroke.pitch.copy(), round(SLIDE_S / HOP_S)
    for before, after in pairwise(stroke.notes):
        if after.is_slide:
            continue
        at = after.start - stroke.start
        lo, hi = max(at - reach, before.start - stroke.start), min(at + reach, len(pitch))
        left = np.flatnonzero(np.abs(pitch[lo:at] - before.pitch) < AT_NOTE)
        arrived = np.flatnonzero(np.abs(pitch[at:hi] - after.pitch) < AT_NOTE)
        if len(left) and len(arrived):
            pitch[lo + left[-1] : at] = pitch[lo + left[-1]]
            pitch[at : at + arrived[0]] = pitch[at + arrived[0]]
    return pitch


def _groups(notes: tuple[HeardNote, ...]) -> list[tuple[int, int]]:
    """The frames of notes that slides connect, which are played with one key."""
    groups: list[tuple[int, int]] = []
    for note in notes:
        if note.is_slide and groups:
            groups[-1] = groups[-1][0], note.end
        else:
            groups.append((note.start, note.end))
    return groups
