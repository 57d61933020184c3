"""The one parameter table. Everything that names, scales or documents a parameter reads it."""

from __future__ import annotations

from yehu_server.errors import ParameterError
from yehu_server.params.spec import Curve, Param, Place

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
        "Normal force of the hair on the bowed string, as far as assist leaves it raw.",
        place=Place.ENGINE, owned=True,
    ),
    Param(
        "/bow/pressure", "F_N / F_max", "1", 0.0, 2.0, 0.4,
        "Bow force as a share of Schelleng's upper limit; fast strokes get up to 0.6 more.",
        place=Place.ENGINE, smooth_ms=10.0, owned=True,
    ),
    Param(
        "/bow/assist", "", "1", 0.0, 1.0, 1.0,
        "1: bow force follows speed (pressure), so the string speaks; 0: raw newtons (force).",
        place=Place.ENGINE, owned=True,
    ),
    Param(
        "/bow/position", "beta", "1", 0.04, 0.5, 0.13,
        "Distance of the bow from the bridge as a share of the sounding length.",
        place=Place.ENGINE, smooth_ms=20.0, owned=True,
    ),
    Param(
        "/finger/1/position", "x_f", "m", 0.008, 0.28, 0.05,
        "Where the finger stops the strings, from the restraining loop.",
        place=Place.ENGINE, owned=True,
    ),
    Param(
        "/finger/1/press", "-f_ext", "N", 0.0, 10.0, 0.0,
        "How hard the finger presses; 0 lifts it.",
        place=Place.ENGINE, smooth_ms=10.0, owned=True,
    ),
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
        "/body/blend", "", "1", 0.0, 1.0, 0.0,
        "From the radiated sound (0) to the bare force of the strings on the bridge (1).",
        place=Place.ENGINE, smooth_ms=20.0,
    ),
    Param(
        "/body/evenness", "", "1", 0.0, 1.0, 0.9,
        "From the body's own loudness of each note (0) to notes that are equally loud (1).",
    ),
    Param(
        "/playing/speed", "", "m/s", 0.03, 0.6, 0.2,
        "Bow speed of a sounding note, as far as the note bears it.", curve=Curve.EXP,
    ),
    Param(
        "/playing/pressure", "", "1", 0.1, 1.0, 0.4,
        "Bow force of a note as a share of Schelleng's upper limit.",
    ),
    Param(
        "/playing/press", "", "N", 0.3, 6.0, 1.5,
        "How hard the finger presses a stopped note.",
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
        "Time in which the bow leaves the string at the end of a note.",
    ),
    Param(
        "/playing/glide", "", "ms", 1.0, 2000.0, 25.0,
        "Time in which the finger slides from one note to the next.",
    ),
)  # fmt: skip

BY_ADDRESS = {param.address: param for param in TABLE}
ENGINE: tuple[Param, ...] = tuple(param for param in TABLE if param.place is Place.ENGINE)
SLOT = {param.address: slot for slot, param in enumerate(ENGINE)}


def find(address: str) -> Param:
    """Return the row of an address. Errors: ParameterError, with a near name if there is one."""
    try:
        return BY_ADDRESS[address]
    except KeyError:
        import difflib

        near = difflib.get_close_matches(address, BY_ADDRESS, n=1, cutoff=0.4)
        hint = f"; did you mean {near[0]}?" if near else ""
        raise ParameterError(f"unknown parameter {address!r}{hint}") from None


def assignment(text: str) -> tuple[str, float]:
    """Read ``ADDRESS=VALUE``. Errors: ParameterError, also for a value out of range."""
    address, equals, value = text.partition("=")
    if not equals:
        raise ParameterError(f"{text!r}: expected ADDRESS=VALUE, such as /bow/position=0.1")
    param = find(address.strip())
    try:
        number = float(value)
    except ValueError:
        raise ParameterError(f"{param.address}: {value!r} is not a number") from None
    if param.accept(number) != number:
        raise ParameterError(f"{param.address}: {number:g} is not within {param.range_text}")
    return param.address, number
