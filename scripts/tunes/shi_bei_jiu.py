"""The traditional tune "Shi Bei Jiu", phrased for a yehu.

The notes were transcribed from a performance, one every 0.125 s. Bowing, dynamics, slides and
vibrato were chosen by ear and follow fixed rules.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

from mido import Message, MidiFile

from tunes.midi import QUARTER, Event, bend, control, parameter, score, stroke

# Each number is the MIDI note of a slot, each line a bar of 2/4, each paragraph a phrase; 0
# prolongs the note before it. The yehu's open strings are 65 (F4) and 72 (C5). Leaps between 69
# and 76 use one finger position on both strings; 65 between high notes is the open string.
PHRASES = """
65 67 65 74 65 67 65 67
72 74 72 69 72 74 72 77

74 77 74 72 69 67 69 72
67 69 67 65 67 69 67 69

72 74 72 69 72 74 72 69
67 70 69 72 67 69 67 69

76 65 74 76 74 76 74 69
67 69 67 69 76 69 76 74

72 74 72 69 72 74 72 74
72 69 72 74 65 67 69 69

67 69 65 67 69 67 69 72
67 65 67 69 72 69 72 76
74 76 74 72 74 76 74 77

72 74 72 69 72 74 72 69
67 70 69 72 67 69 67 69

76  0 74 76 74 76 74 69
67 69 67 69 76 69 76 74

72 74 72 69 72 74 72 74
76 65 74 69 76 69 76 74

72 74 72 69 72 74 72 74
76 65 74 69 76 69 76 74

72 69 72 74 65 67 69 76
74 76 74 72 70 72 70 69

72 69 72 76 74 72 74 77
72 74 72 69 72 74 72 67
"""

SLOT = QUARTER // 4  # a sixteenth: 0.125 s at 120 bpm
BEAT, BAR = 4, 8  # slots
FINAL = 13  # slots of the last note: one, and a bar and a half more
OVERLAP = 6  # ticks by which a slurred note overlaps the next
GAP = 14  # ticks of silence between two bow strokes
BREATH = 30  # ticks of silence after a phrase
LOWEST = 65  # the open string: no slide into it
CROSSING = 5  # semitones: a leap this wide or wider starts a new bow stroke

BEND_RANGE_CENTS = 200
VIBRATO_HZ, VIBRATO_CENTS = 5.5, 15.0

# (slots before the end of the tune, without the longer last note; tempo from there in bpm).
RITARDANDO = ((8, 116), (6, 112), (4, 106), (2, 99), (1, 92))


@dataclass
class Note:
    """One note: its start and length in slots, and how it is bowed."""

    pitch: int
    slot: int
    slots: int
    arch: float  # position in the phrase: 0 at its ends, 1 in its middle
    opens_phrase: bool
    closes_phrase: bool
    slurred: bool = False  # into the next note

    @property
    def start(self) -> int:
        return self.slot * SLOT

    @property
    def end(self) -> int:
        air = -OVERLAP if self.slurred else BREATH if self.closes_phrase else GAP
        return self.start + self.slots * SLOT - air

    @property
    def shaped_end(self) -> int:
        """Return the tick where bends and aftertouch stop: before the next note, slurred or not."""
        return min(self.end, self.start + self.slots * SLOT)

    @property
    def held(self) -> bool:
        return self.slots > 1

    @property
    def velocity(self) -> int:
        accent = 13 if self.slot % BAR == 0 else 7 if self.slot % BEAT == 0 else 0
        if self.slot % 2:
            accent = -5
        return min(max(round(64 + 24 * self.arch + accent), 50), 105)


def read_phrases() -> list[list[int]]:
    """Return the pitches of each phrase, one for each slot."""
    return [[int(pitch) for pitch in phrase.split()] for phrase in PHRASES.split("\n\n")]


def make_notes() -> list[Note]:
    """Return the notes of the tune; slots with the same pitch or 0 prolong the note before."""
    notes: list[Note] = []
    slot = 0
    for phrase in read_phrases():
        first = len(notes)
        for at, pitch in enumerate(phrase):
            if at and pitch in (0, notes[-1].pitch):
                notes[-1].slots += 1
            else:
                arch = math.sin(math.pi * (at + 0.5) / len(phrase))
                notes.append(Note(pitch, slot + at, 1, arch, at == 0, False))
        notes[-1].closes_phrase = True
        slur(notes[first:])
        slot += len(phrase)
    notes[-1].slots = FINAL
    notes[-1].arch = 0.75
    return notes


def slur(phrase: list[Note]) -> None:
    """Slur two notes a stroke, or four in every other bar if the beat spans a fourth at most."""
    for note, following in pairwise(phrase):
        beat = [other for other in phrase if other.slot // BEAT == note.slot // BEAT]
        pitches = [other.pitch for other in beat]
        smooth = max(pitches) - min(pitches) <= CROSSING and note.slot // BAR % 2 == 1
        together = BEAT if smooth else BEAT // 2
        note.slurred = (
            note.slot // together == following.slot // together
            and abs(following.pitch - note.pitch) < CROSSING
            and not following.held  # a long note begins a stroke, because of its slide
        )


def bends(note: Note, tempos: list[tuple[int, float]]) -> Iterator[Event]:
    """Return pitch bends: a slide into the note, then vibrato if it is long."""
    depth, slide = (50.0, 84) if note.held else (35.0, 60)  # cents, ticks
    for tick in range(0, slide, 12):
        yield note.start + tick, bend(-depth * (1.0 - tick / slide) ** 2, BEND_RANGE_CENTS)
    yield note.start + slide, bend(0.0, BEND_RANGE_CENTS)
    if not note.held:
        return
    bpm = [bpm for tick, bpm in tempos if tick <= note.start][-1]
    for tick in range(slide + 12, note.shaped_end - note.start, 12):
        widening = min((tick - slide) / QUARTER * 2.0, 1.0)
        turn = math.sin(2.0 * math.pi * VIBRATO_HZ * (tick - slide) * 60.0 / bpm / QUARTER)
        yield note.start + tick, bend(VIBRATO_CENTS * widening * turn, BEND_RANGE_CENTS)
    yield note.shaped_end, bend(0.0, BEND_RANGE_CENTS)


def swell(note: Note) -> Iterator[Event]:
    """Return aftertouch that rises to the middle of a note and falls to 0 at its end."""
    length = note.shaped_end - note.start
    for tick in range(0, length, 24):
        yield (
            note.start + tick,
            Message("aftertouch", value=round(70 * math.sin(math.pi * tick / length))),
        )
    yield note.shaped_end, Message("aftertouch", value=0)


def dynamics(notes: list[Note]) -> Iterator[Event]:
    """Return CC 11, which rises and falls with each phrase and falls on the last note."""
    for note in notes:
        yield note.start, control(11, round(107 + 20 * note.arch))
    last = notes[-1]
    for slot in range(1, last.slots):
        value = round((107 + 20 * last.arch) * (1.0 - 0.2 * (slot / last.slots) ** 2))
        yield last.start + slot * SLOT, control(11, value)


def shi_bei_jiu() -> MidiFile:
    notes = make_notes()
    slots = sum(map(len, read_phrases()))
    tempos = [(0, 120.0), *((SLOT * (slots - left), float(bpm)) for left, bpm in RITARDANDO)]
    # At the same tick, controls precede notes.
    events = [*parameter(0, BEND_RANGE_CENTS // 100), (0, bend(0.0, BEND_RANGE_CENTS))]
    events += dynamics(notes)
    for note in notes:
        if note.held or (note.opens_phrase and note.pitch > LOWEST):
            events += bends(note, tempos)
        if note.held:
            events += swell(note)
    for note in notes:
        events += stroke(note.pitch, note.velocity, note.start, note.end)
    events.sort(key=lambda event: event[0])
    about = "Ten cups of wine, traditional"
    return score("Shi Bei Jiu", about, "F", tempos, {"Yehu": events})
