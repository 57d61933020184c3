"""The marks of MusicXML, in the names of `notated`; docs/scores.md has the table."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from xml.etree.ElementTree import Element

from yehu_server.errors import one_line
from yehu_server.scores.written.notated import Mark

STEPS: Mapping[str, int] = {"C": 0, "D": 2, "E": 4, "F": 5, "G": 7, "A": 9, "B": 11}
LETTERS = "CDEFGAB"
SHARPS = "FCGDAEB"  # in the order in which keys get them
ACCIDENTALS: Mapping[str, float] = {
    "sharp": 1.0, "flat": -1.0, "natural": 0.0, "double-sharp": 2.0, "sharp-sharp": 2.0,
    "flat-flat": -2.0, "double-flat": -2.0, "quarter-sharp": 0.5, "quarter-flat": -0.5,
}  # fmt: skip
MOST_SHOWN = 40  # characters of an unknown mark

# Elements of <articulations>, <ornaments> and <technical> that are the same mark here.
ARTICULATIONS: Mapping[str, str] = {
    "accent": "accent", "strong-accent": "marcato", "staccato": "staccato", "tenuto": "tenuto",
    "detached-legato": "portato", "staccatissimo": "staccatissimo", "spiccato": "spiccato",
    "scoop": "slide-in-up", "plop": "slide-in-down", "doit": "slide-out-up",
    "falloff": "slide-out-down", "breath-mark": "breath", "caesura": "caesura", "stress": "stress",
    "unstress": "unstress", "soft-accent": "soft-accent",
}  # fmt: skip
TECHNICAL: Mapping[str, str] = {
    "up-bow": "up-bow", "down-bow": "down-bow", "open-string": "open-string",
    "snap-pizzicato": "snap-pizzicato", "harmonic": "harmonic", "open": "open-string",
    "pluck": "pizzicato",
}  # fmt: skip
# Those of which the value is an interval of the key: +1 above, -1 below.
ORNAMENTS: Mapping[str, tuple[str, int]] = {
    "trill-mark": ("trill", 1), "shake": ("trill", 1), "mordent": ("mordent", -1),
    "inverted-mordent": ("inverted-mordent", 1), "turn": ("turn", 1), "delayed-turn": ("turn", 1),
    "vertical-turn": ("turn", 1), "inverted-turn": ("inverted-turn", 1),
    "delayed-inverted-turn": ("inverted-turn", 1), "inverted-vertical-turn": ("inverted-turn", 1),
    "haydn": ("turn", 1),
}  # fmt: skip
# These say nothing about the sound, or are read elsewhere.
SILENT = {"accidental-mark", "tied", "slur", "tuplet", "glissando", "slide", "wavy-line"}
HIGH_STRING, LOW_STRING = 1, 2  # MusicXML counts strings from the highest

Count = Callable[[str], None]


def number(text: str | None, default: float = 0.0) -> float:
    """A number of a few digits, finite; `default` where there is none."""
    try:
        value = float((text or "").strip()[:32])
    except ValueError:
        return default
    return value if abs(value) < 1e9 else default


def printable(text: str) -> str:
    """A mark as a warning shows it."""
    line = one_line(text.strip())
    return line if len(line) <= MOST_SHOWN else f"{line[:MOST_SHOWN]}..."


def neighbour(letter: str, octave: int, steps: int, fifths: int, alter: float | None) -> float:
    """The pitch (MIDI note) of the next or last note of the scale of a key.

    Parameters
    ----------
    alter : float or None
        Its accidental (semitones), where one is written over the ornament.
    """
    at = LETTERS.index(letter) + steps
    octave += at // 7
    name = LETTERS[at % 7]
    if alter is None:
        alter = 0.0
        if fifths > 0 and name in SHARPS[:fifths]:
            alter = 1.0
        elif fifths < 0 and name in SHARPS[fifths:]:
            alter = -1.0
    return 12.0 * (octave + 1) + STEPS[name] + alter


class NoteMarks:
    """Reads the <notations> of one note.

    Parameters
    ----------
    interval : callable
        Semitones from the note to its neighbour above (1) or below (-1) in the key, with an
        accidental of its own or None.
    count : callable
        Told of each mark that is not understood.
    """

    def __init__(self, interval: Callable[[int, float | None], float], count: Count) -> None:
        self._interval = interval
        self._count = count
        self.marks: list[Mark] = []

    def read(self, notations: Element) -> None:
        """Read one <notations> element, but for spans and dynamics."""
        for child in notations:
            if child.tag == "articulations":
                self._articulations(child)
            elif child.tag == "ornaments":
                self._ornaments(child)
            elif child.tag == "technical":
                self._technical(child)
            elif child.tag == "fermata":
                self.add("fermata")
            elif child.tag == "arpeggiate":
                self.add("arpeggio")
            elif child.tag not in SILENT and child.tag != "dynamics":
                self._unknown(child)

    def add(self, name: str, value: float | None = None) -> None:
        """Add a mark."""
        self.marks.append(Mark(name, value))

    def _unknown(self, element: Element) -> None:
        self._count(f"{printable(element.tag)} {printable(element.text or '')}".strip())

    def _articulations(self, articulations: Element) -> None:
        for child in articulations:
            if child.tag in ARTICULATIONS:
                self.add(ARTICULATIONS[child.tag])
            else:
                self._unknown(child)

    def _ornaments(self, ornaments: Element) -> None:
        accidentals = {
            child.get("placement", "above"): ACCIDENTALS.get((child.text or "").strip())
            for child in ornaments
            if child.tag == "accidental-mark"
        }
        for child in ornaments:
            if child.tag in ORNAMENTS:
                name, way = ORNAMENTS[child.tag]
                alter = accidentals.get("above" if way > 0 else "below")
                self.add(name, self._interval(way, alter))
            elif child.tag == "tremolo":
                self._tremolo(child)
            elif child.tag not in SILENT:
                self._unknown(child)

    def _tremolo(self, tremolo: Element) -> None:
        kind = tremolo.get("type", "single")
        strokes = number(tremolo.text, 3.0)
        if kind == "single":
            self.add("tremolo", min(max(strokes, 1.0), 8.0))
        elif kind == "unmeasured":
            self.add("tremolo")
        # `start` and `stop` are over two notes: `voices` makes them a trill.

    def _technical(self, technical: Element) -> None:
        for child in technical:
            if child.tag == "harmonic":
                self._harmonic(child)
            elif child.tag == "string":
                self._string(child)
            elif child.tag == "fingering":
                self._finger(child)
            elif child.tag in TECHNICAL:
                self.add(TECHNICAL[child.tag])
            else:
                self._unknown(child)

    def _harmonic(self, harmonic: Element) -> None:
        if harmonic.find("artificial") is not None:
            self._count("artificial harmonic")
        elif harmonic.find("base-pitch") is None and harmonic.find("touching-pitch") is None:
            self.add("harmonic")
        # Of a harmonic with three notes, the sounding one says it; the others are not played.

    def _string(self, string: Element) -> None:
        value = number(string.text)
        if value == HIGH_STRING:
            self.add("outer-string")
        elif value == LOW_STRING:
            self.add("inner-string")
        else:
            self._count(f"string {printable(string.text or '')}")

    def _finger(self, fingering: Element) -> None:
        text = (fingering.text or "").strip()
        if text in {"0", "1", "2", "3", "4"}:
            self.add("finger", float(text))
        elif text:
            self._count(f"fingering {printable(text)}")
