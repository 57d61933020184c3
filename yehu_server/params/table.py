"""The parameter table, the only source of names, ranges, defaults and descriptions."""

import contextlib
from collections.abc import Mapping
from dataclasses import replace
from functools import partial

from yehu_server.errors import ParameterError, did_you_mean, near_address
from yehu_server.params.articulations import LAST, NUMBER, number_of
from yehu_server.params.spec import Curve, Param, Place

PREFIX = "/yehu"  # before every address, in OSC and OSCQuery
FINGERS = (1, 2, 3, 4)
STRING_NAMES = ("inner", "outer")
LOWEST_A4, HIGHEST_A4 = 390.0, 480.0  # Hz; of the reference pitch, an option of commands and calls


_engine = partial(Param, place=Place.ENGINE)
_controlled = partial(_engine, player_controlled=True)  # while notes sound


def _finger(number: int) -> tuple[Param, Param]:
    return (
        _controlled(f"/finger/{number}/position", "x_f", "m", 0.008, 0.28, 0.05,
            f"Position of finger {number} on the strings, measured from the restraining loop."),
        _controlled(f"/finger/{number}/press", "-f_ext", "N", 0.0, 10.0, 0.0,
            f"Force of finger {number} on the strings; 0 lifts it.", smooth_ms=10.0),
    )  # fmt: skip


def _string(name: str, which: str) -> tuple[Param, Param]:
    return (
        _engine(f"/string/{name}/tuning", "T", "cents", -200.0, 40.0, 0.0,
            f"Detuning of the {which} string by its tension; 0 is in tune.", smooth_ms=50.0),
        _engine(f"/string/{name}/loss", "sigma_0, sigma_1", "1", 0.25, 4.0, 1.0,
            f"Damping of the {which} string, as a factor on the measured one.",
            curve=Curve.EXP, smooth_ms=50.0),
    )  # fmt: skip


TABLE: tuple[Param, ...] = (
    _controlled("/bow/speed", "v_b", "m/s", -2.0, 2.0, 0.0,
        "Speed of the bow; the sign is its direction.", smooth_ms=20.0),
    _controlled("/bow/side", "sign F_N", "1", -1.0, 1.0, 0.0,
        "Which string the hair lies on: 1 the inner (F4), -1 the outer (C5), 0 lifted.",
        smooth_ms=10.0),
    _controlled("/bow/force", "|F_N|", "N", 0.0, 5.0, 0.5,
        "Bow force in newtons; effective where /bow/assist is below 1."),
    _controlled("/bow/pressure", "F_N / F_max", "1", 0.0, 12.0, 0.4,
        "Bow force relative to bow speed, as a fraction of Schelleng's upper limit; fast strokes "
        "get up to 0.6 more.", smooth_ms=10.0),
    _controlled("/bow/assist", "", "1", 0.0, 1.0, 1.0,
        "1: /bow/pressure sets the bow force, so that the string speaks; 0: /bow/force does."),
    _controlled("/bow/position", "beta", "1", 0.04, 0.5, 0.13,
        "Distance of the bow from the bridge as a fraction of the sounding length.",
        smooth_ms=20.0),
    _controlled("/bow/tremolo", "", "1/s", 0.0, 20.0, 0.0,
        "Tremolo: strokes a second, back and forth; 0: the sign of /bow/speed is the direction."),
    _controlled("/bow/tremolo_depth", "", "1", 0.0, 1.0, 0.0,
        "How slowly the bow turns in a tremolo: 0 almost at once, 1 like a pendulum that lingers.",
        smooth_ms=20.0),
    _engine("/bow/noise", "", "1", 0.0, 1.0, 0.025,
        "How much friction varies along the bow, by the rosin on its hair, as a fraction of it: "
        "0.1 is breathy, from 0.2 the tone breaks.", smooth_ms=20.0),
    *(row for number in FINGERS for row in _finger(number)),
    _controlled("/vibrato/depth", "", "cents", 0.0, 200.0, 0.0,
        "Depth of the vibrato to either side, of all fingers that are down.", smooth_ms=20.0),
    _controlled("/vibrato/press", "", "1", 0.0, 1.0, 0.0,
        "Variation of the finger force with the vibrato, as a fraction of it.", smooth_ms=20.0),
    _controlled("/vibrato/upward", "", "1", -1.0, 1.0, 0.0,
        "Middle of the vibrato above the pitch, as a share of its depth: at 0 it goes to both "
        "sides, at 1 only up, twice as far, at -1 only down.",
        smooth_ms=20.0),
    _controlled("/vibrato/rate", "", "Hz", 0.5, 12.0, 6.0,
        "Rate of the vibrato.", smooth_ms=20.0),
    _controlled("/vibrato/onset", "", "1", 0.0, 1.0, 1.0,
        "Fade-in of the vibrato: none up to 0.4, then gradually to its full depth at 1."),
    _controlled("/pluck/force", "F_p", "N", -5.0, 5.0, 0.0,
        "Plucks: pulls a string aside with this force and releases it; above 0 the inner (F4).",
        smooth_ms=12.0),
    _controlled("/pluck/position", "", "1", 0.05, 0.9, 0.3,
        "Distance of the pluck from the bridge as a fraction of the sounding length."),
    *(row for name, note in zip(STRING_NAMES, ("F4", "C5"), strict=True)
      for row in _string(name, f"{name} ({note})")),
    _engine("/output/gain", "", "dB", -60.0, 24.0, 0.0,
        "Gain of the output, before the limiter.", smooth_ms=20.0),
    _controlled("/output/level", "", "1", 0.0, 2.0, 1.0,
        "Amplitude factor of the output, from the player's volume, expression and dynamics.",
        smooth_ms=20.0),
    _controlled("/output/balance", "", "dB", -36.0, 36.0, 0.0,
        "Gain that makes this note as loud as the others of its velocity.", smooth_ms=20.0),
    _engine("/output/limiter", "", "dB", -24.0, 0.0, -3.0,
        "Level above which peaks of the mix are soft-clipped, so that none exceeds -1 dB.",
        smooth_ms=20.0, is_shared=True),
    _engine("/body/gain", "", "dB", -24.0, 24.0, 0.0,
        "Gain of the sound that the body radiates, before the blend.", smooth_ms=20.0),
    _engine("/body/blend", "", "1", 0.0, 1.0, 0.0,
        "Mix from the radiated sound (0) to the force of the strings on the bridge (1).",
        smooth_ms=20.0),
    _engine("/body/width", "", "1", 0.0, 1.0, 0.3,
        "How much the sound of the body differs to both sides, above some 1.5 kHz; 0: not at all.",
        smooth_ms=20.0),
    _engine("/body/sway", "", "1", 0.0, 1.0, 0.5,
        "How far the player sways, and turns the body with it, so that partials rise and fall "
        "apart; 0, or /playing/variation at 0: not at all."),
    _controlled("/body/brilliance", "", "dB", -24.0, 24.0, 0.0,
        "Gain of what lies above /body/brilliance_frequency, from the player's bow: harder and "
        "nearer to the bridge is brighter.", smooth_ms=20.0),
    _controlled("/body/brilliance_frequency", "", "Hz", 200.0, 8000.0, 1300.0,
        "Frequency above which /body/brilliance acts, from the note: there it has half of its "
        "decibels.", curve=Curve.EXP, smooth_ms=20.0),
    _engine("/room/size", "", "m", 2.0, 40.0, 7.0,
        "Length of the room; its width and height go with it.", curve=Curve.EXP, is_shared=True),
    _engine("/room/decay", "", "s", 0.1, 10.0, 0.7,
        "Reverberation time: the time in which the sound of the room decays by 60 dB.",
        curve=Curve.EXP, smooth_ms=50.0, is_shared=True),
    _engine("/room/damping", "", "1", 0.0, 1.0, 0.2,
        "How much sooner high notes decay, above some 2.5 kHz: 0 as low ones, 1 in a fifth of the "
        "time.", smooth_ms=50.0, is_shared=True),
    _engine("/room/level", "", "1", 0.0, 1.0, 0.45,
        "Level of the room: 0 none, 1 as in a room of this size and reverberation time.",
        smooth_ms=50.0, is_shared=True),
    _engine("/room/distance", "", "m", 1.0, 20.0, 3.5,
        "Distance of the player from the listener: farther is quieter, and has more of the room.",
        curve=Curve.EXP, smooth_ms=50.0),
    _engine("/room/pan", "", "1", -1.0, 1.0, 0.0,
        "Place of the player: -1 left, 0 in the middle, 1 right.", smooth_ms=20.0),
    Param("/body/evenness", "", "1", 0.0, 1.0, 0.9,
        "From the body's own loudness of each note (0) to equal loudness of all notes (1)."),
    Param("/playing/dynamics", "", "1", 0.0, 1.0, 1.0,
        "Dynamics, by bow speed and level: 1 gives the full /playing/speed; 0 lifts the bow."),
    Param("/playing/intensity", "", "1", 0.0, 1.0, 0.75,
        "Bow speed and level within the dynamics, over some 20 dB: 0.75 leaves them as the other "
        "parameters say, 1 is louder, 0 is soft but never silent."),
    Param("/playing/speed", "", "m/s", 0.03, 0.6, 0.2,
        "Bow speed at full dynamics; less for notes that do not speak at it.", curve=Curve.EXP),
    Param("/playing/velocity", "", "1", 0.0, 1.0, 0.63,
        "How hard a note is struck: its loudness, by bow and gain, and its attack; 0.63, of a "
        "keyboard's 80, leaves them as the other parameters say."),
    Param("/playing/pressure", "", "1", 0.05, 2.0, 0.4,
        "Bow force relative to bow speed: flautando up to 0.2, ordinary to 0.6, scratching "
        "from 1."),
    Param("/playing/brilliance", "", "1", 0.0, 2.0, 1.0,
        "How much brighter a harder bow sounds, or one nearer to the bridge, than by the model: "
        "0 not at all, 1 as in recordings of fiddles."),
    Param("/playing/bow_position", "", "1", 0.05, 0.3, 0.13,
        "Distance of the bow from the bridge as a fraction of the sounding length."),
    Param("/playing/tremolo", "", "1/s", 0.0, 20.0, 0.0,
        "Tremolo: strokes a second, back and forth; 0: one stroke a note."),
    Param("/playing/tremolo_depth", "", "1", 0.0, 1.0, 0.0,
        "How deep the sound falls between the strokes of a tremolo: 0 by some 7 dB, 1 by 20."),
    Param("/playing/pizzicato", "", "1", 0.0, 1.0, 0.0,
        "From 0.5 up notes are plucked, harder with more /playing/pressure.", is_choice=True),
    Param("/playing/articulation", "", "1", 0.0, float(LAST), 0.0,
        "What both hands do in the notes that begin, such as spiccato, a slide or a trill: a "
        "number of docs/articulations.md; 0: ordinary.", is_choice=True),
    Param("/playing/string", "", "1", 0.0, 2.0, 0.0,
        "String on which notes are played: 0 either, 1 the inner (F4), 2 the outer (C5).",
        is_choice=True),
    Param("/playing/direction", "", "1", -1.0, 1.0, 0.0,
        "Direction of new strokes: 0 alternating, 1 always down, -1 always up.", is_choice=True),
    Param("/playing/bow_length", "", "m", 0.0, 2.0, 0.7,
        "Length of the bow's hair; strokes are planned for it, and turn at its ends. 0: endless."),
    Param("/playing/note_length", "", "s", 0.0, 60.0, 0.0,
        "How long the notes that begin will last, for planning strokes; 0: not known."),
    Param("/playing/press", "", "N", 0.3, 6.0, 1.5,
        "Force of the finger on the string (that of the bow: /playing/pressure)."),
    Param("/playing/vibrato", "", "cents", 0.0, 100.0, 0.0,
        "Depth of the vibrato to either side."),
    Param("/playing/vibrato_press", "", "1", 0.0, 1.0, 0.0,
        "Variation of the finger force with the vibrato, as a fraction of it."),
    Param("/playing/vibrato_rate", "", "Hz", 2.0, 10.0, 6.0,
        "Rate of the vibrato."),
    Param("/playing/vibrato_delay", "", "ms", 0.0, 3000.0, 500.0,
        "Fade-in time of each note's vibrato: none for 0.4 of it, then gradually."),
    Param("/playing/bend", "", "semitones", -48.0, 48.0, 0.0,
        "Pitch bend: distance of the finger from the note.", smooth_ms=8.0),
    Param("/playing/bend_range", "", "semitones", 0.0, 48.0, 2.0,
        "Pitch bend range: the bend at either end of the pitch wheel, until RPN 0 sets it."),
    Param("/playing/volume", "", "1", 0.0, 1.0, 1.0,
        "Level of the instrument (amplitude is its square)."),
    Param("/playing/expression", "", "1", 0.0, 1.0, 1.0,
        "Level within the volume (amplitude is its square)."),
    Param("/playing/assist", "", "1", 0.0, 1.0, 1.0,
        "1: the player's bow force follows bow speed, so that the string speaks; 0: it does not."),
    Param("/playing/variation", "", "1", 0.0, 1.0, 0.25,
        "How much the hands vary: from note to note, in bow speed, bow force, intonation and how "
        "fingers land; and within notes, by drift, tremor and an uneven vibrato."),
    Param("/playing/listening", "", "1", 0.0, 1.0, 1.0,
        "How far the player corrects finger and bow by what the string does: 0 plays by measured "
        "tables alone."),
    Param("/playing/phrasing", "", "1", 0.0, 1.0, 0.0,
        "How much the player shapes plain notes by itself: vibrato that comes late on long notes, "
        "slides on leaps. Files get phrases, accents and slurs too (render --phrasing)."),
    Param("/playing/left_hand", "", "1", 0.0, 1.0, 1.0,
        "How far phrasing moves the left hand too: its own vibrato, slides and scoops; 0 leaves "
        "these to bends and controllers."),
    Param("/playing/section", "", "1", 1.0, 16.0, 1.0,
        "Number of players of this part, each on an instrument of their own; at most as many as "
        "it began with.", is_choice=True),
    Param("/playing/attack", "", "ms", 5.0, 500.0, 40.0,
        "Time in which the bow reaches the speed and force of a new note."),
    Param("/playing/release", "", "ms", 5.0, 2000.0, 60.0,
        "Time in which the bow leaves the string at the end of a note; not the call "
        f"{PREFIX}/release."),
    Param("/playing/portamento", "", "1", 0.0, 1.0, 0.0,
        "From 0.5 up the finger slides from note to note; below, it steps.", is_choice=True),
    Param("/playing/portamento_time", "", "ms", 5.0, 2000.0, 120.0,
        "Duration of a portamento slide."),
    Param("/engine/calibration", "", "1", 0.0, 1.0, 1.0,
        "1: fingers stop where the model was measured to be in tune; 0: where an ideal string is."),
    Param("/engine/seed", "", "1", 0.0, 65535.0, 0.0,
        "Seed of the random numbers of /playing/variation; a new one restarts their sequence.",
        is_choice=True),
)  # fmt: skip

UNIT = "/unit"  # suffix of an address: the same parameter as 0 to 1

# What values of a list are called.
NAMES: Mapping[str, Mapping[str, float]] = {
    "/playing/articulation": NUMBER,
    "/playing/string": {"either": 0.0, "inner": 1.0, "outer": 2.0},
    "/playing/direction": {"alternating": 0.0, "down": 1.0, "up": -1.0},
    **{each: {"off": 0.0, "on": 1.0} for each in ("/playing/pizzicato", "/playing/portamento")},
}
BY_ADDRESS = {param.address: param for param in TABLE}
ENGINE: tuple[Param, ...] = tuple(param for param in TABLE if param.place is Place.ENGINE)
SLOT = {param.address: slot for slot, param in enumerate(ENGINE)}


def find(address: str) -> Param:
    """Find the parameter of an address; ParameterError, with a similar one, where there is none."""
    try:
        return BY_ADDRESS[address]
    except KeyError:
        # Those that the player does not move come first.
        known = sorted(BY_ADDRESS, key=lambda each: BY_ADDRESS[each].player_controlled)
        hint = near_address(address, known, prefix=PREFIX) or "; docs/parameters.md has all"
        raise ParameterError(f"unknown parameter {address!r}{hint}") from None


def read(values: Mapping[str, float], address: str) -> float:
    """The value of a parameter; at ADDRESS/unit, as 0 to 1."""
    plain = address.removesuffix(UNIT)
    value = values[plain]
    return value if plain == address else offered(BY_ADDRESS[plain]).to_unit(value)


def full_address(name: str) -> str:
    """The one address whose last part, or last parts, a name is; else the name itself."""
    ends = [each for each in BY_ADDRESS if each.endswith(f"/{name.strip().lstrip('/')}")]
    return ends[0] if len(ends) == 1 else name.strip()


def assignment(text: str) -> tuple[str, float]:
    """Read ``ADDRESS=VALUE``.

    A last part that one address alone has stands for it; a value may be one of its `NAMES`.
    Raises ParameterError where the text has another form, the address is unknown, or the value is
    out of range.
    """
    address, equals, value = text.partition("=")
    if not equals:
        raise ParameterError(f"{text!r}: expected ADDRESS=VALUE, such as /playing/bow_position=0.1")
    param = find(full_address(address))
    try:
        number = float(value)
    except ValueError:
        number = named(param, value)
    if param.clamped(number) != number:
        raise ParameterError(f"{param.address}: {number:g} is not within {param.range_text}")
    return param.address, there_is(param, number)


def named(param: Param, name: str) -> float:
    """The value that one of `NAMES` is of; raises ParameterError where it is none.

    An articulation's Chinese name is one as well.
    """
    names = NAMES.get(param.address, {})
    if names is NUMBER:
        with contextlib.suppress(ParameterError):
            return float(number_of(name))
    if name not in names:
        what = f"neither a number nor one of {', '.join(names)}" if names else "not a number"
        raise ParameterError(f"{param.address}: {name!r} is {what}{did_you_mean(name, names)}")
    return names[name]


def offered(param: Param) -> Param:
    """A parameter with what there is to choose as its range: messages may have higher numbers."""
    names = NAMES.get(param.address)
    return replace(param, hi=max(names.values())) if names else param


def there_is(param: Param, value: float) -> float:
    """A value that a person chose; of a choice, ParameterError where it has no such number."""
    if not param.is_choice:
        return value
    lo, hi = param.lo, offered(param).hi
    if not (value.is_integer() and lo <= value <= hi):
        wanted = f"expected a whole number from {lo:g} to {hi:g}, got {value:g}"
        raise ParameterError(f"{param.address}: {wanted}")
    return value
