"""The marks of a note as values of parameters, mostly by ear (docs/scores.md)."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from operator import itemgetter
from typing import NamedTuple

from yehu_server.core.player.harmonics import SAME_PITCH, SPEAKING, sounding_above
from yehu_server.core.player.note_range import YEHU, NoteRange
from yehu_server.params.articulations import ARTICULATIONS, NUMBER
from yehu_server.params.table import find
from yehu_server.scores.written.notated import FORCED, Note, Part, Sign

Values = dict[str, float]

LEFT_HAND = "/playing/left_hand"
ARTICULATION, TREMOLO_DEPTH = "/playing/articulation", "/playing/tremolo_depth"
DIRECTION, STRING, TREMOLO = "/playing/direction", "/playing/string", "/playing/tremolo"
PIZZICATO, PRESSURE, VIBRATO = "/playing/pizzicato", "/playing/pressure", "/playing/vibrato"
BOW_POSITION, SPEED = "/playing/bow_position", "/playing/speed"
ATTACK, RELEASE = "/playing/attack", "/playing/release"
GAIN = "/body/gain"

DOWN, UP, INNER, OUTER = 1.0, -1.0, 1.0, 2.0
STRING_SIGNS = {"inner-string": INNER, "outer-string": OUTER, "either-string": 0.0}
# Strokes a second of an unmeasured tremolo, and its depth: those of the gesture.
_TREMOLO = ARTICULATIONS[NUMBER["tremolo"]]
QUICK_TREMOLO, DEEP = _TREMOLO.tremolo, _TREMOLO.tremolo_depth
MEASURED = 2  # so many strokes through a stem are counted; more are as quick as hands go
VIBRATO_CENTS = 30.0
SNAP = 0.8  # pressure: a pluck twice as hard as usual
# The bow's places are those of the presets.
PLACES: Mapping[str, Values] = {
    "sul-ponticello": {BOW_POSITION: 0.09, SPEED: 0.16},
    "sul-tasto": {BOW_POSITION: 0.18, SPEED: 0.155},
    "flautando": {PRESSURE: 0.2, SPEED: 0.24},
}
CRISP: Mapping[str, Values] = {
    "staccatissimo": {ATTACK: 25.0, RELEASE: 25.0},
    "staccato": {ATTACK: 25.0, RELEASE: 40.0},
    "marcato": {ATTACK: 25.0},
}


# Marks that ask for an articulation, before any other of their note.
SLIDES: Mapping[str, str] = {"slide-in-up": "slide-up", "slide-in-down": "slide-down"}
# The same, after others, on notes that last so long (s).
GESTURES: Mapping[str, tuple[str, float]] = {
    "spiccato": ("spiccato", 0.0),
    "soft-accent": ("swell", 0.5),
}
ASKING = {"articulation", *SLIDES, *GESTURES}
FORCED_GESTURE = "sforzando", 0.4
PLUCKED = {"pizzicato", "snap-pizzicato"}
# Marks that set no parameter: notes that have no others are many.
SET_NOTHING = {
    "trill", "mordent", "inverted-mordent", "turn", "inverted-turn", "accent", "tenuto", "fermata",
}  # fmt: skip


class Node(NamedTuple):
    """A harmonic: its string, and the note that a finger would stop where it touches."""

    string: float
    touched: float


@lru_cache(maxsize=16)
def harmonics_of(within: NoteRange) -> Mapping[float, Node]:
    """The harmonics of an instrument, by the pitch that sounds (MIDI note)."""
    return {
        within.open_notes[string] + sounding_above(parts): Node(
            (INNER, OUTER)[string], within.open_notes[string] + touched
        )
        for string, touched, parts in SPEAKING
    }


PLUCKED_DB = -3.5  # beside bowed notes: the peaks of plucked ones are some 8 dB higher


class Active(NamedTuple):
    """The signs that hold at a beat of a part."""

    plucked: bool = False
    slurred: bool = False
    short: bool = False
    tremolo: bool = False
    place: str = ""
    string: float = 0.0
    articulation: float = 0.0
    gesture: float = 0.0
    is_forced: bool = False
    vibrato: float | None = None

    def with_sign(self, sign: Sign) -> Active:  # noqa: PLR0911 - one for each kind
        """The same with a sign that holds from here on."""
        name, value = sign.name, sign.value
        if name in FORCED:
            return self._replace(is_forced=True)
        if name in ("pizz", "arco"):
            plucked = name == "pizz"
            return self._replace(
                plucked=plucked, tremolo=self.tremolo and plucked, articulation=0.0
            )
        if name in ("legato", "non-legato"):
            return self._replace(slurred=name == "legato")
        if name in ("staccato", "non-staccato"):
            return self._replace(short=name == "staccato")
        if name == "tremolo":
            return self._replace(tremolo=True)
        if name in PLACES:
            return self._replace(place=name)
        if name == "ordinary":
            return self._replace(place="", tremolo=False, short=False, articulation=0.0)
        if name == "articulation":
            return self._replace(articulation=value or 0.0)
        if name == "gesture":
            return self._replace(gesture=value or 0.0)
        if name in STRING_SIGNS:
            return self._replace(string=STRING_SIGNS[name])
        if name == "vibrato":
            return self._replace(vibrato=VIBRATO_CENTS if value is None else value)
        return self


PLAIN = Active()  # where no sign holds


def actives_of(part: Part) -> list[Active]:
    """The signs that hold at each note of a part; some are written for one note alone."""
    ordered = sorted(((float(sign.beat), sign) for sign in part.signs), key=itemgetter(0))
    signs, now, found = ordered[::-1], PLAIN, []
    for begins_at in part.begins_at:
        if now.gesture or now.is_forced:
            now = now._replace(gesture=0.0, is_forced=False)
        while signs and signs[-1][0] <= begins_at:
            now = now.with_sign(signs.pop()[1])
        found.append(now)
    return found


def harmonic_of(note: Note, within: NoteRange = YEHU) -> Node | None:
    """The node of a note's harmonic; None where it is no harmonic, or one that does not speak."""
    if "harmonic" not in note.names:
        return None
    known = harmonics_of(within)
    near = min(known, key=lambda pitch: abs(pitch - note.pitch))
    return known[near] if abs(near - note.pitch) <= SAME_PITCH else None


def is_plucked(note: Note, active: Active) -> bool:
    """Whether a note is plucked."""
    return active.plucked or not PLUCKED.isdisjoint(note.names)


def values_of(note: Note, active: Active, quarter_s: float, within: NoteRange = YEHU) -> Values:
    """Return the parameters that a note's marks and the signs before it set, by address."""
    values = _held(active)
    number = articulation_of(note, active, quarter_s)
    if not (note.marks or values or active.plucked or number):
        return values
    if number:
        values[ARTICULATION] = number
    for mark in note.marks:
        name, value = mark.name, mark.value
        values |= CRISP.get(name, {})
        if name in ("up-bow", "down-bow"):
            values[DIRECTION] = UP if name == "up-bow" else DOWN
        elif name in ("inner-string", "outer-string"):
            values[STRING] = INNER if name == "inner-string" else OUTER
        elif name in ("open-string", "finger"):
            values |= _fingered(note, 0.0 if name == "open-string" else value, within)
        elif name == "tremolo":
            values |= _trembled(_strokes(value, quarter_s))
        elif name == "vibrato":
            values |= _vibrato(VIBRATO_CENTS if value is None else value)
        elif name == "snap-pizzicato":
            values[PRESSURE] = SNAP
    if is_plucked(note, active):
        values |= {PIZZICATO: 1.0, GAIN: PLUCKED_DB}
        for address in (TREMOLO, TREMOLO_DEPTH, *([] if slide_of(note) else [ARTICULATION])):
            values.pop(address, None)
    node = harmonic_of(note, within)
    if node is not None:
        values |= {ARTICULATION: float(NUMBER["flageolet"]), STRING: node.string}
    elif "harmonic" in note.names:
        values |= PLACES["flautando"]
    return {address: find(address).clamped(value) for address, value in values.items()}


def _held(active: Active) -> Values:
    """The values that the signs which hold set."""
    values: Values = dict(PLACES.get(active.place, {}))
    if active.string:
        values[STRING] = active.string
    if active.tremolo:
        values |= _trembled(QUICK_TREMOLO)
    values |= _vibrato(active.vibrato)
    return values | (CRISP["staccato"] if active.short else {})


def articulation_of(note: Note, active: Active, quarter_s: float) -> float:
    """The articulation that is written for a note, by its number; 0 for none."""
    if not active.is_forced and note.names.isdisjoint(ASKING):
        return active.gesture or active.articulation
    length_s = float(note.length) * quarter_s
    mark = note.marked("articulation")
    if (slide := slide_of(note)) or mark:
        return slide or (mark.value if mark else None) or 0.0
    for name, (gesture, least_s) in GESTURES.items():
        if name in note.names and length_s >= least_s:
            return float(NUMBER[gesture])
    if active.gesture:
        return active.gesture
    gesture, least_s = FORCED_GESTURE
    if active.is_forced and length_s >= least_s:
        return float(NUMBER[gesture])
    return active.articulation


def slide_of(note: Note) -> float:
    """The articulation of a written slide into a note, by its number; 0 for none."""
    names = note.names
    if names.isdisjoint(SLIDES):
        return 0.0
    return next(float(NUMBER[name]) for mark, name in SLIDES.items() if mark in names)


def _trembled(strokes: float) -> Values:
    return {TREMOLO: strokes} | ({TREMOLO_DEPTH: DEEP} if strokes == QUICK_TREMOLO else {})


def _strokes(strokes: float | None, quarter_s: float) -> float:
    if strokes is None or strokes > MEASURED:
        return QUICK_TREMOLO
    return float(min(2.0 ** max(strokes, 1.0) / quarter_s, QUICK_TREMOLO))


def _vibrato(cents: float | None) -> Values:
    if cents is None:
        return {}
    # At 0 the player would shake long notes by itself.
    return {VIBRATO: cents} if cents > 0.0 else {VIBRATO: 0.0, LEFT_HAND: 0.0}


def _fingered(note: Note, finger: float | None, within: NoteRange) -> Values:
    """The string that a finger number implies, at the pitch of the open outer string."""
    if finger is None or abs(note.pitch - within.open_notes[1]) > SAME_PITCH:
        return {}
    return {STRING: OUTER if finger == 0.0 else INNER}
