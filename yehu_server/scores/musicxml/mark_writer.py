"""Write the marks of notes as elements of MusicXML: what `marks` reads, the other way."""

from __future__ import annotations

from collections import Counter
from xml.etree.ElementTree import Element, SubElement

from yehu_server.params.articulations import ARTICULATIONS
from yehu_server.scores.musicxml.marks import ACCIDENTALS, MARKS, ORNAMENTS, neighbour
from yehu_server.scores.written.layout import LETTERS, spelled
from yehu_server.scores.written.notated import Mark, Note

# Elements by marks: the first of those that are read alike, and the group that it is in.
ELEMENTS = {mark: element for element, mark in reversed([*MARKS.items()])}
GROUPED = {
    "accent", "strong-accent", "staccato", "tenuto", "detached-legato", "staccatissimo",
    "spiccato", "scoop", "plop", "doit", "falloff", "breath-mark", "caesura", "stress", "unstress",
    "soft-accent",
}  # fmt: skip
NOTATIONS = {"fermata", "arpeggiate"}
ORNAMENT_OF = {mark: (element, way) for element, (mark, way) in reversed([*ORNAMENTS.items()])}
SIGNS = {alter: name for name, alter in reversed([*ACCIDENTALS.items()])}


class MarkWriter:
    """Writes marks into <notations>; counts in `lost` those that MusicXML cannot say."""

    def __init__(self, lost: Counter[str]) -> None:
        self._lost = lost

    def write(self, notations: Element, note: Note, fifths: int) -> None:
        """Write all marks of a note, in a key of so many sharps."""
        if note.contour:
            self._lost["pitches that move within a note"] += 1
        for mark in note.marks:
            name, value = mark.name, mark.value
            if name in ORNAMENT_OF:
                self._ornament(notations, note, mark, fifths)
            elif name == "tremolo":
                words = {"type": "unmeasured" if value is None else "single"}
                element = SubElement(SubElement(notations, "ornaments"), "tremolo", words)
                element.text = "0" if value is None else f"{value:g}"
            elif name == "finger" and value is not None:
                self._technical(notations, "fingering", f"{value:g}")
            elif name in ("inner-string", "outer-string"):
                self._technical(notations, "string", "2" if name == "inner-string" else "1")
            elif name == "articulation" and value is not None:
                group = SubElement(notations, "articulations")
                SubElement(group, "other-articulation").text = ARTICULATIONS[int(value)].name
            elif name == "harmonic" and value is None:
                self._technical(notations, "harmonic")
            elif name == "vibrato" and value is None:
                SubElement(
                    SubElement(notations, "ornaments"), "wavy-line", type="start", number="16"
                )
            elif name in ELEMENTS and value is None:
                self._plain(notations, ELEMENTS[name])
            else:
                self._lost[name if value is None else f"{name} {value:g}"] += 1

    def _plain(self, notations: Element, name: str) -> None:
        if name in NOTATIONS:
            SubElement(notations, name)
        elif name in GROUPED:
            SubElement(SubElement(notations, "articulations"), name)
        else:
            self._technical(notations, name)

    def _technical(self, notations: Element, name: str, text: str = "") -> None:
        element = SubElement(SubElement(notations, "technical"), name)
        if text:
            element.text = text

    def _ornament(self, notations: Element, note: Note, mark: Mark, fifths: int) -> None:
        """An ornament, with the accidental that its other note needs."""
        element, way = ORNAMENT_OF[mark.name]
        letter, _, octave = spelled(note.pitch, fifths)
        name = LETTERS[letter]
        group = SubElement(notations, "ornaments")
        SubElement(group, element)
        if mark.value is None:
            return
        other = note.pitch + way * mark.value
        if abs(abs(neighbour(name, octave, way, fifths, None) - note.pitch) - mark.value) < 1e-6:
            return
        needed = other - neighbour(name, octave, way, fifths, 0.0)
        if needed in SIGNS:
            place = "above" if way > 0 else "below"
            SubElement(group, "accidental-mark", placement=place).text = SIGNS[needed]
        else:
            self._lost[f"{mark.name} of {mark.value:g} semitones"] += 1
