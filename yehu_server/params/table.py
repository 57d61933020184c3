"""The one parameter table. Everything that names, scales or documents a parameter reads it."""

from __future__ import annotations

from collections.abc import Mapping

from yehu_server.errors import ParameterError
from yehu_server.params.spec import Curve, Param, Place

PREFIX = "/yehu"  # before every address, in OSC and OSCQuery
FINGERS = (1, 2, 3, 4)
STRING_NAMES = ("inner", "outer")


def _finger(number: int) -> tuple[Param, Param]:
    return (
        Param(
            f"/finger/{number}/position", "x_f", "m", 0.008, 0.28, 0.05,
            f"Where finger {number} stops the strings, from the restraining loop.",
            place=Place.ENGINE, owned=True,
        ),
        Param(
            f"/finger/{number}/press", "-f_ext", "N", 0.0, 10.0, 0.0,
            f"How hard finger {number} presses the strings; 0 lifts it.",
            place=Place.ENGINE, smooth_ms=10.0, owned=True,
        ),
    )  # fmt: skip


def _string(name: str, which: str) -> tuple[Param, Param]:
    return (
        Param(
            f"/string/{name}/tuning", "T", "cents", -200.0, 40.0, 0.0,
            f"Tension of the {which} string, as cents from where it is in tune.",
            place=Place.ENGINE, smooth_ms=50.0,
        ),
        Param(
            f"/string/{name}/loss", "sigma_0, sigma_1", "1", 0.25, 4.0, 1.0,
            f"Damping of the {which} string, as a factor of the measured one.",
            place=Place.ENGINE, curve=Curve.EXP, smooth_ms=50.0,
        ),
    )  # fmt: skip


TABLE: tuple[Param, ...] = (
    Param(
        "/bow/speed", "v_b", "m/s", -2.0, 2.0, 0.0,
        "Speed of the bow; the sign is its direction.",
        place=Place.ENGINE, smooth_ms=20.0, owned=True,
    ),
    Param(
        "/bow/side", "sign F_N", "1", -1.0, 1.0, 0.0,
        "Which string the hair lies on: 1 the inner (F4), -1 the outer (C5), 0 lifted.",
        place=Place.ENGINE, smooth_ms=10.0, owned=True,
    ),
    Param(
        "/bow/force", "|F_N|", "N", 0.0, 5.0, 0.5,
        "How hard the bow leans on the string, in newtons; heard as far as /bow/assist is below 1.",
        place=Place.ENGINE, owned=True,
    ),
    Param(
        "/bow/pressure", "F_N / F_max", "1", 0.0, 12.0, 0.4,
        "How hard the bow leans for its speed, as a share of Schelleng's upper limit; fast strokes "
        "get up to 0.6 more.",
        place=Place.ENGINE, smooth_ms=10.0, owned=True,
    ),
    Param(
        "/bow/assist", "", "1", 0.0, 1.0, 1.0,
        "1: the bow leans by /bow/pressure, so that the string speaks; 0: by /bow/force, newtons.",
        place=Place.ENGINE, owned=True,
    ),
    Param(
        "/bow/position", "beta", "1", 0.04, 0.5, 0.13,
        "Distance of the bow from the bridge as a share of the sounding length.",
        place=Place.ENGINE, smooth_ms=20.0, owned=True,
    ),
    Param(
        "/bow/tremolo", "", "1/s", 0.0, 20.0, 0.0,
        "Strokes a second, back and forth; 0 leaves the bow's direction to speed.",
        place=Place.ENGINE, owned=True,
    ),
    Param(
        "/bow/noise", "", "1", 0.0, 1.0, 0.0,
        "Bow force trembles by this share of itself: 0.1 breathes, from 0.5 the tone breaks.",
        place=Place.ENGINE, smooth_ms=20.0,
    ),
    *(row for number in FINGERS for row in _finger(number)),
    Param(
        "/vibrato/depth", "", "cents", 0.0, 200.0, 0.0,
        "How far the fingers that are down rock to either side.",
        place=Place.ENGINE, smooth_ms=20.0, owned=True,
    ),
    Param(
        "/vibrato/press", "", "1", 0.0, 1.0, 0.0,
        "How much harder and softer they press in turn, as a share of how hard they press.",
        place=Place.ENGINE, smooth_ms=20.0, owned=True,
    ),
    Param(
        "/vibrato/rate", "", "Hz", 0.5, 12.0, 5.5,
        "How often they rock.",
        place=Place.ENGINE, smooth_ms=20.0, owned=True,
    ),
    Param(
        "/vibrato/onset", "", "1", 0.0, 1.0, 1.0,
        "How far the vibrato has come in: nothing up to 0.4, then gently to all of it.",
        place=Place.ENGINE, owned=True,
    ),
    Param(
        "/pluck/force", "F_p", "N", -5.0, 5.0, 0.0,
        "Plucks: pulls a string aside as hard as this, and lets go. Above 0 the inner (F4).",
        place=Place.ENGINE, smooth_ms=12.0, owned=True,
    ),
    Param(
        "/pluck/position", "", "1", 0.05, 0.9, 0.3,
        "Where, from the bridge, as a share of the sounding length.",
        place=Place.ENGINE, owned=True,
    ),
    *(row for name, note in zip(STRING_NAMES, ("F4", "C5"), strict=True)
      for row in _string(name, f"{name} ({note})")),
    Param(
        "/output/gain", "", "dB", -60.0, 24.0, 0.0,
        "Gain of the output, before the limiter.",
        place=Place.ENGINE, smooth_ms=20.0,
    ),
    Param(
        "/output/level", "", "1", 0.0, 1.0, 1.0,
        "Amplitude factor of the output: the player's volume times expression.",
        place=Place.ENGINE, smooth_ms=20.0, owned=True,
    ),
    Param(
        "/output/balance", "", "dB", -36.0, 36.0, 0.0,
        "Gain that makes this note as loud as the others.",
        place=Place.ENGINE, smooth_ms=20.0, owned=True,
    ),
    Param(
        "/output/limiter", "", "dB", -24.0, 0.0, -3.0,
        "Level above which peaks are bent; at 0 they are cut off at full scale.",
        place=Place.ENGINE, smooth_ms=20.0,
    ),
    Param(
        "/body/gain", "", "dB", -24.0, 24.0, 0.0,
        "Gain of what the body radiates, before the blend.",
        place=Place.ENGINE, smooth_ms=20.0,
    ),
    Param(
        "/body/blend", "", "1", 0.0, 1.0, 0.0,
        "From the radiated sound (0) to the bare force of the strings on the bridge (1).",
        place=Place.ENGINE, smooth_ms=20.0,
    ),
    Param(
        "/body/evenness", "", "1", 0.0, 1.0, 0.9,
        "From the body's own loudness of each note (0) to notes that are equally loud (1).",
    ),
    Param(
        "/playing/dynamics", "", "1", 0.0, 1.0, 1.0,
        "From nothing, where the bow is lifted, to all that speed and volume give.",
    ),
    Param(
        "/playing/speed", "", "m/s", 0.03, 0.6, 0.2,
        "Bow speed of a note at full dynamics, as far as the note bears it.", curve=Curve.EXP,
    ),
    Param(
        "/playing/pressure", "", "1", 0.05, 2.0, 0.4,
        "How hard the bow leans for its speed: flautando up to 0.2, ordinary to 0.6, scratching "
        "from 1.",
    ),
    Param(
        "/playing/bow_position", "", "1", 0.05, 0.3, 0.13,
        "Distance of the bow from the bridge as a share of the sounding length.",
    ),
    Param(
        "/playing/tremolo", "", "1/s", 0.0, 20.0, 0.0,
        "Strokes a second, back and forth; 0 for one stroke a note.",
    ),
    Param(
        "/playing/pizzicato", "", "1", 0.0, 1.0, 0.0,
        "From 0.5 up notes are plucked, harder with more /playing/pressure.", is_choice=True,
    ),
    Param(
        "/playing/string", "", "1", 0.0, 2.0, 0.0,
        "Which string takes the notes: 0 whichever fits, 1 the inner (F4), 2 the outer (C5).",
        is_choice=True,
    ),
    Param(
        "/playing/direction", "", "1", -1.0, 1.0, 0.0,
        "Of new strokes: 0 back and forth in turn, 1 always down, -1 always up.", is_choice=True,
    ),
    Param(
        "/playing/press", "", "N", 0.3, 6.0, 1.5,
        "How hard the finger presses the string (the bow has /playing/pressure).",
    ),
    Param(
        "/playing/vibrato", "", "cents", 0.0, 100.0, 0.0,
        "How far the finger rocks to either side.",
    ),
    Param(
        "/playing/vibrato_press", "", "1", 0.0, 1.0, 0.0,
        "How much harder and softer the finger presses in turn, as a share of how hard it presses.",
    ),
    Param(
        "/playing/vibrato_rate", "", "Hz", 2.0, 10.0, 5.5,
        "How often it rocks.",
    ),
    Param(
        "/playing/vibrato_delay", "", "ms", 0.0, 3000.0, 500.0,
        "Time in which the vibrato of a note comes in: none for 0.4 of it, then gently.",
    ),
    Param(
        "/playing/bend", "", "semitones", -48.0, 48.0, 0.0,
        "How far the finger has slid from the note.", smooth_ms=8.0,
    ),
    Param(
        "/playing/bend_range", "", "semitones", 0.0, 48.0, 2.0,
        "Bend at the end of the pitch wheel's way, until RPN 0 sets it.",
    ),
    Param(
        "/playing/volume", "", "1", 0.0, 1.0, 1.0,
        "Level of the instrument (amplitude is its square).",
    ),
    Param(
        "/playing/expression", "", "1", 0.0, 1.0, 1.0,
        "Level within the volume (amplitude is its square).",
    ),
    Param(
        "/playing/assist", "", "1", 0.0, 1.0, 1.0,
        "1: the player's bow force follows bow speed, so the string speaks; 0: it does not.",
    ),
    Param(
        "/playing/variation", "", "1", 0.0, 1.0, 0.25,
        "How much one note differs from the next in speed, force and finger, by chance.",
    ),
    Param(
        "/playing/attack", "", "ms", 5.0, 500.0, 40.0,
        "Time in which bow speed and force reach a new note.",
    ),
    Param(
        "/playing/release", "", "ms", 5.0, 2000.0, 60.0,
        "Time in which the bow leaves the string at the end of a note (no kin of "
        f"{PREFIX}/release).",
    ),
    Param(
        "/playing/portamento", "", "1", 0.0, 1.0, 0.0,
        "From 0.5 up the finger slides from note to note; else it steps.", is_choice=True,
    ),
    Param(
        "/playing/portamento_time", "", "ms", 5.0, 2000.0, 120.0,
        "How long such a slide takes.",
    ),
    Param(
        "/engine/calibration", "", "1", 0.0, 1.0, 1.0,
        "1: fingers go to where the model was measured to be in tune; 0: to an ideal string's.",
    ),
    Param(
        "/engine/seed", "", "1", 0.0, 65535.0, 0.0,
        "Of the chance in /playing/variation; a new one begins its sequence anew.", is_choice=True,
    ),
)  # fmt: skip

UNIT = "/unit"  # an address with this at its end is the parameter as 0 to 1

BY_ADDRESS = {param.address: param for param in TABLE}
ENGINE: tuple[Param, ...] = tuple(param for param in TABLE if param.place is Place.ENGINE)
SLOT = {param.address: slot for slot, param in enumerate(ENGINE)}


def find(address: str) -> Param:
    """Return the row of an address. Errors: ParameterError, with a near name if there is one."""
    try:
        return BY_ADDRESS[address]
    except KeyError:
        import difflib

        # The whole of a last name is nearer than any likeness, such as that of /bow/position.
        near = [known for known in BY_ADDRESS if known.endswith(f"/{address.lstrip('/')}")]
        near = near or difflib.get_close_matches(address, BY_ADDRESS, n=1, cutoff=0.4)
        hint = f"; did you mean {near[0]}?" if near else ""
        raise ParameterError(f"unknown parameter {address!r}{hint}") from None


def read(values: Mapping[str, float], address: str) -> float:
    """Look up a parameter's value, or at ADDRESS/unit the same as 0 to 1."""
    plain = address.removesuffix(UNIT)
    value = values[plain]
    return value if plain == address else BY_ADDRESS[plain].to_unit(value)


def assignment(text: str) -> tuple[str, float]:
    """Read ``ADDRESS=VALUE``. Errors: ParameterError, also for a value out of range."""
    address, equals, value = text.partition("=")
    if not equals:
        raise ParameterError(f"{text!r}: expected ADDRESS=VALUE, such as /playing/bow_position=0.1")
    param = find(address.strip())
    try:
        number = float(value)
    except ValueError:
        raise ParameterError(f"{param.address}: {value!r} is not a number") from None
    if param.accept(number) != number:
        raise ParameterError(f"{param.address}: {number:g} is not within {param.range_text}")
    return param.address, number
