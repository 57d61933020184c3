"""The traditional tune "Mo Li Hua" for four yehus, in heterophony.

One tune, as ensembles of Chinese fiddles play it: each player at the same time in a way of their
own. The first plays it plainly. The second adds flowers (jia hua): notes of the scale between
those of the tune. The third plays its bones (jian zi): what falls on the beats. The fourth plays
it an octave higher where the instrument reaches, and slides into long notes. The notes of the
tune are those that are sung in Jiangsu; all else follows fixed rules.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

from mido import MidiFile

from tunes.midi import QUARTER, Event, bend, parameter, score, stroke

BPM = 76
RITARDANDO = ((4, 70), (3, 64), (2, 56))  # beats before the end, tempo from there

# Degree and length in eighths; "5," is below, "1'" above. A line is a phrase; bars of 2/4.
TUNE = """
3:2 3 5 6 1' 1' 6 5:2 5 6 5:4
3:2 3 5 6 1' 1' 6 5:2 5 6 5:4
5:2 5:2 5:2 3 5 6:2 6:2 5:4
3:2 2 3 5:2 3 2 1:2 1 2 1:4
3 2 1 3 2:3 3 5:2 6 1' 5:4
2:2 3 5 2 3 1 6, 5,:4 6,:2 1:2
2:3 3 1 2 1 6, 5,:8
"""
DEGREES = {"1": 0, "2": 2, "3": 4, "5": 7, "6": 9}  # semitones above do: no others
DO, LOWEST, HIGHEST = 70, 65, 89  # B flat: the open strings are sol and re
OCTAVE = 12
SCALE = [
    DO + octave + step
    for octave in (-OCTAVE, 0, OCTAVE)
    for step in DEGREES.values()
    if LOWEST <= DO + octave + step <= HIGHEST
]
EIGHTH, SIXTEENTH = QUARTER // 2, QUARTER // 4
AIR = 12  # ticks of silence before a new stroke
OVERLAP = 6  # ticks by which a slurred note overlaps the next
BREATH = 40  # ticks of silence after a phrase
BEND_RANGE_CENTS = 200
SLIDE_CENTS, SLIDE = 70, 100  # how far below a slide begins; how long it is (ticks)
VELOCITY, ACCENT = 68, 10  # of a note; more on the first beat of a bar
BAR = 2 * QUARTER


@dataclass(frozen=True)
class Note:
    """A note: its pitch (MIDI), start and length (ticks), and whether a phrase ends with it."""

    pitch: int
    start: int
    length: int
    is_last: bool = False

    @property
    def end(self) -> int:
        return self.start + self.length


def tune() -> list[Note]:
    """Return the notes of the tune."""
    notes: list[Note] = []
    tick = 0
    for line in TUNE.strip().splitlines():
        words = line.split()
        for number, word in enumerate(words, start=1):
            degree, _, eighths = word.partition(":")
            pitch = DO + DEGREES[degree[0]]
            pitch += OCTAVE * (degree.count("'") - degree.count(","))
            length = EIGHTH * int(eighths or 1)
            notes.append(Note(pitch, tick, length, number == len(words)))
            tick += length
    return notes


def plain(notes: list[Note]) -> list[Note]:
    """Return the tune as it is."""
    return notes


def flowers(notes: list[Note]) -> list[Note]:
    """Fill notes with those of the scale: a turn, then the way to the next note."""
    played = []
    for note, after in pairwise([*notes, notes[-1]]):
        if note.is_last or note.length < EIGHTH:
            played.append(note)
            continue
        above = step(note.pitch, 1)
        leading = step(after.pitch, 1 if after.pitch <= note.pitch else -1)
        figure = [note.pitch, leading]
        if note.length >= 2 * EIGHTH:
            figure = [note.pitch, above, note.pitch, leading]
        if leading == note.pitch:  # the next note is a step away
            figure[-1] = above
        lengths = [note.length - SIXTEENTH * (len(figure) - 1)] + [SIXTEENTH] * (len(figure) - 1)
        start = note.start
        for pitch, length in zip(figure, lengths, strict=True):
            played.append(Note(pitch, start, length))
            start += length
    return played


def bones(notes: list[Note]) -> list[Note]:
    """Leave out what does not fall on a beat; a note lasts until the next."""
    on_beats = [note for note in notes if note.start % QUARTER == 0]
    kept = [on_beats[0]]
    for note in on_beats[1:]:
        if note.pitch == kept[-1].pitch and not kept[-1].is_last:
            continue  # one long note
        kept.append(note)
    ends = [*(note.start for note in kept[1:]), notes[-1].end]
    closing = {note.start for note in notes if note.is_last}
    return [
        Note(
            note.pitch, note.start, end - note.start, any(note.start <= at < end for at in closing)
        )
        for note, end in zip(kept, ends, strict=True)
    ]


def octave(notes: list[Note]) -> list[Note]:
    """Play bars an octave higher where all their notes are within reach."""
    high = {note.start // BAR for note in notes if note.pitch + OCTAVE > HIGHEST}
    return [
        note if note.start // BAR in high
        else Note(note.pitch + OCTAVE, note.start, note.length, note.is_last)
        for note in notes
    ]  # fmt: skip


def step(pitch: int, steps: int) -> int:
    """Return the note of the scale some steps away; at its ends, the outermost."""
    return SCALE[min(max(SCALE.index(pitch) + steps, 0), len(SCALE) - 1)]


def slurred(notes: list[Note], at: int) -> bool:
    """Whether a note is in one bow with the next: the second of a beat with its first."""
    note, after = notes[at], notes[at + 1] if at + 1 < len(notes) else notes[at]
    same_beat = note.start // QUARTER == after.start // QUARTER
    return same_beat and not note.is_last and after.pitch != note.pitch


def messages(notes: list[Note], channel: int, *, slides: bool) -> list[Event]:
    """Return the messages of a part, with their ticks."""
    found = parameter(0, BEND_RANGE_CENTS // 100, channel)
    for number, note in enumerate(notes):
        if slides and note.length >= QUARTER and note.pitch > LOWEST:
            for tick in range(0, SLIDE + 1, 10):
                cents = -SLIDE_CENTS * (1.0 - tick / SLIDE) ** 2
                found.append((note.start + tick, bend(cents, BEND_RANGE_CENTS, channel)))
        air = -OVERLAP if slurred(notes, number) else BREATH if note.is_last else AIR
        velocity = VELOCITY + (ACCENT if note.start % BAR == 0 else 0)
        found += stroke(note.pitch, velocity, note.start, note.end - air, channel)
    return sorted(found, key=lambda event: (event[0], event[1].type == "note_on"))


Way = Callable[[list[Note]], list[Note]]
PARTS: dict[str, tuple[Way, bool]] = {
    "plain": (plain, False),
    "flowers": (flowers, False),
    "bones": (bones, True),
    "octave": (octave, True),
}


def mo_li_hua() -> MidiFile:
    notes = tune()
    slowing = [(notes[-1].end - QUARTER * beats, float(bpm)) for beats, bpm in RITARDANDO]
    parts = {
        name: messages(way(notes), channel, slides=slides)
        for channel, (name, (way, slides)) in enumerate(PARTS.items())
    }
    about = "Jasmine flower, traditional"
    return score("Mo Li Hua", about, "Bb", [(0, float(BPM)), *slowing], parts)
