"""Figures of pitches: how jianpu writes a note in a key."""

from __future__ import annotations

from yehu_server.scores.jianpu.scale import LOWEST_DO, MIDDLE_C
from yehu_server.scores.written.layout import LETTERS, STEPS, key_alter, spelled

DO_FIFTHS = {-6: "Gb", -5: "Db", -4: "Ab", -3: "Eb", -2: "Bb", -1: "F", 0: "C", 1: "G", 2: "D",
             3: "A", 4: "E", 5: "B", 6: "F#"}  # fmt: skip


def written_key(fifths: int) -> int:
    """A key signature as one of those that have a name here, from six flats to six sharps."""
    return (fifths + 5) % 12 - 5


def figure_of(pitch: float, fifths: int) -> tuple[str, int]:
    """Return the figure of a pitch with its accidental, and by how many octaves it is marked.

    Of a MIDI note the nearest semitone is written; `fifths` is that of `written_key`.
    """
    letter, alter, octave = spelled(pitch, fifths)
    name = DO_FIFTHS[fifths]
    first = LETTERS.index(name[0])
    do = (STEPS[first] - LOWEST_DO) % 12.0 + LOWEST_DO + {"#": 1, "b": -1}.get(name[1:], 0)
    degree = (letter - first) % 7
    sign = round(alter) - key_alter(letter, fifths)
    natural = 12 * (octave + 1) + STEPS[letter] + key_alter(letter, fifths)
    octaves = round((natural - MIDDLE_C - do - STEPS[degree]) / 12)
    return f"{'#' * sign if sign > 0 else 'b' * -sign}{degree + 1}", octaves
