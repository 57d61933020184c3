"""MusicXML's marks of notes, by the names of `notated`: read and written (docs/scores.md)."""

from collections import Counter
from collections.abc import Callable, Iterable, Mapping
from fractions import Fraction
from xml.etree.ElementTree import Element, SubElement

from yehu_server.params.articulations import ARTICULATIONS
from yehu_server.scores.musicxml.elements import SCHEMA
from yehu_server.scores.score import printable
from yehu_server.scores.written.layout import LETTERS, spelled
from yehu_server.scores.written.notated import Mark
from yehu_server.scores.written.ornaments import WAYS, Alters, Around, around_in
from yehu_server.scores.written.words import ARTICULATED

ACCIDENTALS: Mapping[str, float] = {
    "sharp": 1.0, "flat": -1.0, "natural": 0.0, "double-sharp": 2.0, "sharp-sharp": 2.0,
    "flat-flat": -2.0, "double-flat": -2.0, "quarter-sharp": 0.5, "quarter-flat": -0.5,
}  # fmt: skip

# Names of lengths (quarters).
VALUES: Mapping[str, Fraction] = {
    "long": Fraction(16), "breve": Fraction(8), "whole": Fraction(4), "half": Fraction(2),
    "quarter": Fraction(1), "eighth": Fraction(1, 2), "16th": Fraction(1, 4),
    "32nd": Fraction(1, 8), "64th": Fraction(1, 16), "128th": Fraction(1, 32),
}  # fmt: skip
# Elements of <notations>, <articulations> and <technical> that are the same mark here.
NOTATIONS: Mapping[str, str] = {"fermata": "fermata", "arpeggiate": "arpeggio"}
GROUPED: Mapping[str, str] = {
    "accent": "accent", "strong-accent": "marcato", "staccato": "staccato", "tenuto": "tenuto",
    "detached-legato": "portato", "staccatissimo": "staccatissimo", "spiccato": "spiccato",
    "scoop": "slide-in-up", "plop": "slide-in-down", "doit": "slide-out-up",
    "falloff": "slide-out-down", "breath-mark": "breath", "caesura": "caesura", "stress": "stress",
    "unstress": "unstress", "soft-accent": "soft-accent",
}  # fmt: skip
MARKS: Mapping[str, str] = {
    **NOTATIONS, **GROUPED,
    "up-bow": "up-bow", "down-bow": "down-bow", "open-string": "open-string", "open": "open-string",
    "snap-pizzicato": "snap-pizzicato", "pluck": "pizzicato",
}  # fmt: skip
ORNAMENTS: Mapping[str, str] = {
    "trill-mark": "trill", "shake": "trill", "mordent": "mordent",
    "inverted-mordent": "inverted-mordent", "turn": "turn", "delayed-turn": "turn",
    "vertical-turn": "turn", "inverted-turn": "inverted-turn",
    "delayed-inverted-turn": "inverted-turn", "inverted-vertical-turn": "inverted-turn",
    "haydn": "turn",
}  # fmt: skip
# These say nothing about the sound, or are read elsewhere.
IGNORED = {
    "accidental-mark", "tied", "slur", "tuplet", "glissando", "slide", "wavy-line", "dynamics",
}  # fmt: skip
GROUPS = {"articulations", "ornaments", "technical"}
STRINGS = {1.0: "outer-string", 2.0: "inner-string"}  # counted from the highest
Count = Callable[[str], None]
# Elements by marks: the first of those that are read alike.
ELEMENTS = {mark: element for element, mark in reversed([*MARKS.items()])}
ORNAMENT_OF = {mark: element for element, mark in reversed([*ORNAMENTS.items()])}
SIGNS = {alter: name for name, alter in reversed([*ACCIDENTALS.items()])}


def plain(text: str | None) -> str:
    """Words of a mark as tables have them."""
    return " ".join((text or "").split()).lower()


def number(text: str | None, default: float = 0.0) -> float:
    """A number of a few digits, finite; `default` where there is none."""
    try:
        value = float((text or "").strip()[:32])
    except ValueError:
        return default
    return value if abs(value) < 1e9 else default


class NoteMarks:
    """Reads the <notations> of one note.

    `intervals` are those to its neighbours, where they have an accidental of the ornament; `count`
    is called with each unknown mark.
    """

    def __init__(self, intervals: Callable[[float], Around], count: Count) -> None:
        self._intervals = intervals
        self._count = count
        self.marks: list[Mark] = []

    def read(self, parent: Element) -> None:
        """Read one <notations> element or group in it, but for spans and dynamics."""
        for child in parent:
            tag = child.tag
            if tag in GROUPS:
                self.read(child)
            elif tag in MARKS:
                self._add(MARKS[tag])
            elif tag in ORNAMENTS:
                self._ornament(ORNAMENTS[tag], parent)
            elif tag == "tremolo":
                self._tremolo(child)
            elif tag.startswith("other-") and (text := plain(child.text)) in ARTICULATED:
                self._add("articulation", ARTICULATED[text][1])
            elif tag == "harmonic":
                self._harmonic(child)
            elif tag == "string" and number(child.text) in STRINGS:
                self._add(STRINGS[number(child.text)])
            elif tag == "fingering" and (child.text or "").strip() in {*"01234", ""}:
                if finger := (child.text or "").strip():
                    self._add("finger", float(finger))
            elif tag not in IGNORED and tag in SCHEMA:
                self._count(f"{printable(tag)} {printable(child.text or '')}".strip())

    def _add(self, name: str, value: float | None = None) -> None:
        self.marks.append(Mark(name, value))

    def _ornament(self, name: str, ornaments: Element) -> None:
        """An ornament; the accidentals written over it, and under it, go over those of the bar."""
        ways = WAYS[name]
        said: list[float | None] = [None] * len(ways)
        for mark in ornaments.iterfind("accidental-mark"):
            alter = ACCIDENTALS.get((mark.text or "").strip())
            if alter is not None:
                at = len(ways) - 1 if mark.get("placement") == "below" else 0
                said[at] = self._intervals(alter)[ways[at] < 0]
        self.marks.append(Mark(name, *said))

    def _tremolo(self, tremolo: Element) -> None:
        kind = tremolo.get("type", "single")
        if kind == "single":
            self._add("tremolo", min(max(number(tremolo.text, 3.0), 1.0), 8.0))
        elif kind == "unmeasured":
            self._add("tremolo")
        # `start` and `stop` are over two notes: `voices` makes them a trill.

    def _harmonic(self, harmonic: Element) -> None:
        if harmonic.find("artificial") is not None:
            self._count("artificial harmonic")
        elif harmonic.find("base-pitch") is None and harmonic.find("touching-pitch") is None:
            self._add("harmonic")
        # Of a harmonic with three notes, the sounding one says it; the others are not played.


class MarkWriter:
    """Writes marks into <notations>; counts in `lost` those that MusicXML cannot say.

    `alters` are the accidentals that hold in the bar so far.
    """

    def __init__(self, lost: Counter[str]) -> None:
        self._lost = lost
        self.alters: Alters = {}

    def write(self, notations: Element, pitch: float, marks: Iterable[Mark], fifths: int) -> None:
        """Write marks of a note of a pitch, in a key of so many sharps."""
        for mark in marks:
            name, value = mark.name, mark.value
            if name in ORNAMENT_OF:
                self._ornament(notations, pitch, mark, fifths)
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

    def _ornament(self, notations: Element, pitch: float, mark: Mark, fifths: int) -> None:
        """An ornament, with the accidental that its other note needs."""
        letter, alter, octave = spelled(pitch, fifths)
        place = LETTERS[letter], octave, alter
        group = SubElement(notations, "ornaments")
        SubElement(group, ORNAMENT_OF[mark.name])
        plain = around_in(place, self.alters, fifths)
        for way, value in zip(WAYS[mark.name], (mark.value, mark.second), strict=False):
            if value is None or abs(plain[way < 0] - value) < 1e-6:
                continue
            fits = [
                own
                for own in SIGNS
                if abs(around_in(place, {}, fifths, own)[way < 0] - value) < 1e-6
            ]
            if fits:
                own = min(fits, key=lambda own: (abs(own), -way * own))
                where = "above" if way > 0 else "below"
                SubElement(group, "accidental-mark", placement=where).text = SIGNS[own]
            else:
                self._lost[f"{mark.name} of {value:g} semitones"] += 1
