"""Scores that show what each controller does to the sound: see `examples.py`.

The tunes were written for this project, in B flat: the open strings are its fifth and second
degrees (sol and re). A flat or a lowered A, and E flat or a raised E flat, imitate the "heavy"
mode of Chaozhou music.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import islice, pairwise

from mido import Message, MetaMessage, MidiFile

from tunes.midi import QUARTER, Event, bend, control, parameter, score, stroke

# Notation of a part: PITCH:BEATS is a note, r:BEATS a rest, and (N) sets the dynamics, which move
# smoothly to the next (N). A pitch may have an offset in cents (81-35) or glide by semitones
# within its note (74^5). Marks: ~ slurs the note into the next, > slides into the next,
# / slides into this note from below, p is a soft attack, f a firm one.
TOKEN = re.compile(
    r"(?P<pitch>\d+|r)(?P<cents>[+-]\d+)?(\^(?P<glide>\d+))?:(?P<beats>[\d.]+)(?P<marks>[~>/pf]*)"
)

AIR_BPM = 63
AIR = """
r:1 (34) 65:0.5p~ 67:0.5~ 70:3 (64) 72:0.5~ 70:0.5 74:1.5 (80) 72:0.5~ 70:1~ 67:1 65:3.5p (20)
r:0.5 (36) 67:1p~ 70:1 72:0.5~ 70:0.5~ 74:1.5> (68) 77:2.5 (88) 79:0.5~ 77:0.5~ 74:1
72:0.5~ 70:0.5~ 74:3.5 (26)
r:0.5 (48) 77:1~ 80:1 82:2 (80) 80:0.5~ 82:0.5~ 80:1> (92) 84:3f (100) 82:0.5~ 80:0.5~ 77:1
75:1.5~ (70) 72:0.5 75:1~ 77:2.5 (32)
r:0.5 (44) 74:1.5p~ 72:0.5~ 70:1~ (66) 67:1 72:1~ 70:1> 67:2 (40) 65:0.5p~ 67:0.5~ 70:4 (8)
"""
RITARDANDO = ((8, 60), (6, 57), (5, 54))  # (beats before the end, tempo from there)

STUDY_BPM = 88
SWEEPS = "67:3.75 r:0.25 70:3.75 r:0.25 74:3.75 r:0.25 79:3.75 r:0.25"
PHRASE = "67:0.5~ 70:0.5 74:0.75~ 77:0.25 74:0.5~ 72:0.5 70:0.75 r:0.25"
STUDY = f"r:2 (104) {SWEEPS} {SWEEPS} {PHRASE} {PHRASE} {PHRASE}"
FORCES = (8, 40, 100)  # CC 71 in the three phrases: flautando, ordinary, pressed

MPE_BPM = 76
MPE = """
r:1 (40) 74:1.5/p 77:0.5~ (68) 79:2 77:0.5~ 75+35:0.5~ 77:1 (44)
74^5:3.5p (86) 82:0.5~ 81-35:0.5~ 79:0.5~ 77:1 (54)
82:0.5/~ 84:2.5f (106) 82:0.5~ 81-35:0.5~ 77:1~ 75+35:1 (60)
77:0.5~ 75+35:0.5~ 72:0.5~ 70:0.5~ 67:1.5/ (76) 70:0.5~ 72:0.5~ 74:0.5 (58) 70:4/ (10)
"""
MEMBERS = 15
MASTER_RANGE, MEMBER_RANGE = 200, 4800  # cents up or down, from the MPE specification

VELOCITY = {"p": 48, "": 98, "f": 116}
MPE_SOFTER = 14  # of velocity: pressure adds to it
OVERLAP = 16  # ticks by which a slurred note overlaps the next
GAP = 20  # ticks of silence between two bow strokes
TAIL = 2 * QUARTER  # from the end of the last note to the end of the track
SAMPLE_S, BEND_SAMPLE_S = 0.020, 0.010
OPEN_STRINGS = (65, 72)  # notes without vibrato, as no finger stops them
LONG = 3 * QUARTER // 2  # shortest note with vibrato
LOUDEST, COMPRESSION = 127.0, 0.5  # of the levels below: as loud as other music, with a floor
SWELL = 14  # added to the dynamics in the middle of notes of two beats or more
VIBRATO_HZ, VIBRATO_CENTS = 5.5, 25.0
VIBRATO_FROM_S, VIBRATO_FADE_S = 0.5, 0.4  # after the start of the note, before its end
SLIDE_CENTS, SLIDE_S = 180.0, 0.22

ORDINARY_FORCE, ORDINARY_POSITION = 40, 64  # CC 71, CC 74
EXPRESSION, VIBRATO, FORCE, POSITION, GLIDE_TIME, GLIDE = 11, 77, 71, 74, 5, 65

Curve = Callable[[float], float]  # a value for each tick


@dataclass
class Note:
    """One note of a part, with times in ticks."""

    pitch: int
    cents: float
    glide: float  # semitones up
    start: int
    length: int  # to the next note or rest
    marks: str

    @property
    def slurred(self) -> bool:
        return "~" in self.marks or ">" in self.marks

    @property
    def until(self) -> int:
        """Return the tick at which the curves of this note stop."""
        return self.start + self.length - (0 if self.slurred else GAP)

    @property
    def end(self) -> int:
        return self.until + (OVERLAP if self.slurred else 0)

    @property
    def velocity(self) -> int:
        return VELOCITY["p" if "p" in self.marks else "f" if "f" in self.marks else ""]

    @property
    def shaken(self) -> bool:
        return self.length >= LONG and self.pitch not in OPEN_STRINGS

    def place(self, tick: float) -> float:
        """Return the position of a tick within the note, from 0 at its start to 1 at its end."""
        return min(max((tick - self.start) / (self.until - self.start), 0.0), 1.0)


# ---------------------------------------------------------------- curves


def step(x: float) -> float:
    """Return a smooth step from 0 to 1 with zero slope at both ends (smoothstep)."""
    x = min(max(x, 0.0), 1.0)
    return x * x * (3.0 - 2.0 * x)


def hill(x: float) -> float:
    """Return a smooth bump: 0 at both ends, 1 in the middle, with zero slope at all three."""
    return 16.0 * x * x * (1.0 - x) * (1.0 - x)


def sampled(curve: Curve, start: int, end: int, every: int) -> Iterator[tuple[int, int]]:
    """Sample a curve as integers; yield the first value, then each value that changes."""
    before = None
    for tick in (*range(start, end, every), end):
        value = round(curve(tick))
        if value != before:
            yield tick, value
        before = value


def dynamics(notes: list[Note], levels: list[tuple[int, int]]) -> Curve:
    """Join levels smoothly and add a swell to each note of two beats or more."""

    def curve(tick: float) -> float:
        level = float(levels[0][1] if tick < levels[0][0] else levels[-1][1])
        for (start, low), (end, high) in pairwise(levels):
            if start <= tick < end:
                level = low + (high - low) * step((tick - start) / (end - start))
        swells = (hill(note.place(tick)) for note in notes if note.length >= 2 * QUARTER)
        level = min(level + SWELL * sum(swells), 127.0)
        return float(LOUDEST * (level / 127.0) ** COMPRESSION)

    return curve


def vibrato(note: Note, bpm: int, depth: float) -> Curve:
    """Return vibrato depth: 0 at the start or during a glide, then growing, 0 at the end."""
    second = QUARTER * bpm / 60
    fade = note.until - VIBRATO_FADE_S * second
    first = note.start + (0.75 * note.length if note.glide else VIBRATO_FROM_S * second)

    def curve(tick: float) -> float:
        grown = step((tick - first) / (fade - first))
        return depth * grown * step((note.until - tick) / (note.until - fade))

    return curve


# ---------------------------------------------------------------- a part and its file


def read(part: str) -> tuple[list[Note], list[tuple[int, int]]]:
    """Parse a part; return its notes and its dynamics (tick and level)."""
    notes: list[Note] = []
    levels: list[tuple[int, int]] = []
    now = 0
    for word in part.split():
        if word.startswith("("):
            levels.append((now, int(word.strip("()"))))
            continue
        token = TOKEN.fullmatch(word)
        if token is None:
            raise ValueError(f"not a note: {word}")
        length = round(float(token["beats"]) * QUARTER)
        if token["pitch"] != "r":
            cents, glide = float(token["cents"] or 0), float(token["glide"] or 0)
            notes.append(Note(int(token["pitch"]), cents, glide, now, length, token["marks"]))
        now += length
    return notes, levels


def ticks(seconds: float, bpm: int) -> int:
    return round(seconds * QUARTER * bpm / 60)


def strokes(note: Note, channel: int = 0, softer: int = 0) -> tuple[Event, Event]:
    return stroke(note.pitch, note.velocity - softer, note.start, note.end, channel)


def file(name: str, about: str, tempos: list[tuple[int, float]], events: list[Event]) -> MidiFile:
    """Return a score; events at a tick keep their order: controls before the notes they shape."""
    events = sorted(events, key=lambda event: event[0])
    end = (events[-1][0] + TAIL, MetaMessage("end_of_track"))
    return score(name, about, "Bb", tempos, {"Yehu": [*events, end]})


def at_rest() -> list[Event]:
    """Return the initial values of all controllers that a keyboard-expressive score uses."""
    rest = (
        (VIBRATO, 0),
        (GLIDE_TIME, 64),
        (GLIDE, 0),
        (FORCE, ORDINARY_FORCE),
        (POSITION, ORDINARY_POSITION),
    )
    return [(0, control(*each)) for each in rest]


# ---------------------------------------------------------------- the scores


def vibrato_depths(notes: list[Note], loudness: Curve, bpm: int) -> list[Event]:
    """Return CC 77 for the vibrato of long notes, deeper on louder notes."""
    events: list[Event] = []
    for note in notes:
        if note.shaken:
            depth = 20.0 + 0.6 * loudness(note.start + 0.7 * note.length)
            shape = vibrato(note, bpm, depth)
            drawn = sampled(shape, note.start, note.until, ticks(SAMPLE_S, bpm))
            events += ((tick, control(VIBRATO, value)) for tick, value in drawn)
    return events


def slides(notes: list[Note]) -> list[Event]:
    """Turn portamento on for the second note of each slide; wide slides are slower."""
    events: list[Event] = []
    for note, target in pairwise(notes):
        if ">" in note.marks:
            before = target.start - QUARTER // 8
            events.append((before, control(GLIDE_TIME, 32 + 10 * abs(target.pitch - note.pitch))))
            events.append((before, control(GLIDE, 127)))
            events.append((target.until, control(GLIDE, 0)))
    return events


def slow_air() -> MidiFile:
    notes, levels = read(AIR)
    end = notes[-1].start + notes[-1].length
    loudness = dynamics(notes, levels)
    swells = sampled(loudness, 0, notes[-1].until, ticks(SAMPLE_S, AIR_BPM))
    events = [
        *at_rest(),
        *((tick, control(EXPRESSION, value)) for tick, value in swells),
        *vibrato_depths(notes, loudness, AIR_BPM),
        *slides(notes),
        *(event for note in notes for event in strokes(note)),
    ]
    slowing = [(end - left * QUARTER, float(bpm)) for left, bpm in RITARDANDO]
    about = (
        "A slow air: swells by CC 11, vibrato by CC 77, slides by CC 65. For keyboard-expressive"
    )
    return file("Slow Air", about, [(0, AIR_BPM), *slowing], events)


def sweep(note: Note, number: int) -> Iterator[Event]:
    """Move a controller from 0 to 127 and back during one note."""

    def curve(tick: float) -> float:
        return 127.0 * hill(note.place(tick))

    for tick, value in sampled(curve, note.start, note.until, ticks(SAMPLE_S, STUDY_BPM)):
        yield tick, control(number, value)


def bow_pressure() -> MidiFile:
    notes, levels = read(STUDY)
    events = [*at_rest(), (0, control(EXPRESSION, levels[0][1]))]
    left = iter(notes)
    for swept, other, ordinary in (
        (FORCE, POSITION, ORDINARY_POSITION),
        (POSITION, FORCE, ORDINARY_FORCE),
    ):
        for note in islice(left, len(read(SWEEPS)[0])):
            events.append((note.start, control(other, ordinary)))
            events += sweep(note, swept)
    for force in FORCES:
        first, *_ = islice(left, len(read(PHRASE)[0]))
        events.append((first.start, control(FORCE, force)))
        events.append((first.start, control(POSITION, ORDINARY_POSITION)))
    events += (event for note in notes for event in strokes(note))
    about = "A study in bow force (CC 71) and bow position (CC 74). For keyboard-expressive"
    return file("Bow Pressure", about, [(0, STUDY_BPM)], events)


def pitch_of(note: Note) -> Curve:
    """Return the pitch curve of a note in cents from its MIDI note: slide, glide and vibrato."""
    shaking = vibrato(note, MPE_BPM, VIBRATO_CENTS)
    second = QUARTER * MPE_BPM / 60

    def curve(tick: float) -> float:
        since = (tick - note.start) / second
        cents = note.cents
        if "/" in note.marks:
            cents -= SLIDE_CENTS * (1.0 - min(since / SLIDE_S, 1.0)) ** 2
        if note.glide:
            cents += 100.0 * note.glide * step((note.place(tick) - 0.3) / 0.45)
        if note.shaken:
            cents += shaking(tick) * math.sin(2.0 * math.pi * VIBRATO_HZ * since)
        return cents

    return curve


def drawn_note(note: Note, channel: int, loudness: Curve) -> Iterator[Event]:
    """Write a note and its curves on its own channel; first values precede the note."""
    pitch = pitch_of(note)
    steps = sampled(
        lambda tick: pitch(tick) / MEMBER_RANGE * 8192,
        note.start,
        note.until,
        ticks(BEND_SAMPLE_S, MPE_BPM),
    )
    for tick, value in steps:
        yield tick, Message("pitchwheel", channel=channel, pitch=value)
    every = ticks(SAMPLE_S, MPE_BPM)
    for tick, value in sampled(loudness, note.start, note.until, every):
        yield tick, Message("aftertouch", channel=channel, value=value)
    # The louder the note, the nearer the bow is to the bridge.
    places = sampled(lambda tick: 36.0 + 0.45 * loudness(tick), note.start, note.until, every)
    for tick, value in places:
        yield tick, control(POSITION, value, channel)
    yield from strokes(note, channel, MPE_SOFTER)


def zone() -> list[Event]:
    """Return the MPE Configuration Message, the bend ranges and the initial controller values."""
    members = range(1, MEMBERS + 1)
    events = [*parameter(6, MEMBERS), *parameter(0, MASTER_RANGE // 100)]
    for channel in members:
        events += parameter(0, MEMBER_RANGE // 100, channel)
    for channel in (0, *members):
        events.append((0, bend(0.0, MEMBER_RANGE, channel)))
    for channel in members:
        events.append((0, Message("aftertouch", channel=channel, value=0)))
        events.append((0, control(POSITION, ORDINARY_POSITION, channel)))
    return events


def mpe_phrase() -> MidiFile:
    notes, levels = read(MPE)
    loudness = dynamics(notes, levels)
    events = zone()
    for number, note in enumerate(notes):
        events += drawn_note(note, 1 + number % MEMBERS, loudness)
    last = notes[-1]
    dip = sampled(
        lambda tick: -8192.0 * hill(step((last.place(tick) - 0.3) / 0.5)),
        last.start,
        last.until,
        ticks(BEND_SAMPLE_S, MPE_BPM),
    )
    events += ((tick, Message("pitchwheel", channel=0, pitch=value)) for tick, value in dip)
    about = "Bend, pressure and bow position of each note's own, drawn by hand. For mpe"
    return file("MPE Phrase", about, [(0, MPE_BPM)], events)
