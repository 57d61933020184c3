"""The players of all parts and sections: their instruments, seats and random numbers.

The first of a section has the measured instrument; those of the others differ as instruments of one
maker do.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np

from yehu_server.core.engine.ensemble import Ensemble
from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.rig import MAX_PARTS
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.core.midi.section_players import DISTANCE, GAIN, OWN_SEED, PAN, own_value
from yehu_server.core.physics.default_quantities import Body, Quantities, StringQuantities
from yehu_server.core.physics.elementary import exp2, sin_and_cos
from yehu_server.core.physics.radiation import pole_of
from yehu_server.core.player.note_tables import NoteTables
from yehu_server.core.player.parameter_indices import INDEX
from yehu_server.errors import ParameterError
from yehu_server.params.table import find
from yehu_server.playing.options import PlayingOptions
from yehu_server.playing.player import Player

SECTION = "/playing/section"

# A maker's tolerances, as fractions to either side, by ear. Bodies of one size differ as a whole,
# by their size, and mode by mode.
SIZE, MODE, MASS, DAMPING = 0.025, 0.01, 0.05, 0.1
DENSITY, STIFFNESS, LOSS = 0.02, 0.05, 0.1
ROSIN = 0.03
TUNED_CENTS = 1.5  # how well a player tunes

MAX_HAIRS = SEEDS = 1 << 16
WIDEST = 0.7  # pan of the outermost players; by ear: the room stays around them


def section_size(playing: PlayingOptions) -> int:
    """How many players are asked for."""
    asked = dict(playing.mapping.start) | dict(playing.start) | dict(playing.settings)
    return round(find(SECTION).clamped(asked.get(SECTION, 1.0)))


def part_specs(
    playing: PlayingOptions, rate: float, calibration: NoteTables, *, number: int
) -> list[InstrumentSpec]:
    """The instruments of a part, alone or a section's, after `number` others on the stage."""
    players = section_size(playing)
    if players > 1:
        return section_specs(playing, rate, calibration, players=players)
    return [playing.spec(rate, calibration, body=number)]


def section_specs(
    playing: PlayingOptions, rate: float, calibration: NoteTables, *, players: int
) -> list[InstrumentSpec]:
    """The instruments of a section; the first has that of ``PlayingOptions.spec``.

    `rate` (Hz).
    `players`: how many play it.
    """
    base = playing.quantities

    def spec(number: int) -> InstrumentSpec:
        seed = round(own_value(INDEX[OWN_SEED], float(playing.seed), number, players))
        tuned, own = (calibration, base) if number == 0 else vary(calibration, base, seed)
        values = {
            address: own_value(INDEX[address], find(address).default, number, players)
            for address in (GAIN, PAN, DISTANCE)
        }
        player, body = replace(playing, seed=seed, quantities=own), seed if number else 0
        return player.spec(rate, tuned, start_values=values, body=body, player_number=number)

    return [spec(number) for number in range(players)]


def vary(
    calibration: NoteTables, quantities: Quantities, seed: int
) -> tuple[NoteTables, Quantities]:
    """Another instrument of the same maker, tuned by its player.

    The strings' tensions follow their densities, so that it is in tune with the first.
    """
    by_chance = np.random.default_rng(seed)

    def factor(tolerance: float) -> float:
        return 1.0 + float(by_chance.uniform(-tolerance, tolerance))

    strings: list[StringQuantities] = []
    tensions: list[float] = []
    for string, tension in zip(quantities.strings, calibration.tensions, strict=True):
        density, loss = factor(DENSITY), factor(LOSS)
        tuned = exp2(float(by_chance.uniform(-TUNED_CENTS, TUNED_CENTS)) / 600.0)
        rho, stiffness = string.rho * density, string.E * factor(STIFFNESS)
        losses = {"sigma_0": string.sigma_0 * loss, "sigma_1": string.sigma_1 * loss}
        strings.append(replace(string, rho=rho, E=stiffness, **losses))
        tensions.append(tension * density * tuned)
    rosin = factor(ROSIN)
    bow = replace(
        quantities.bow,
        mu_C=quantities.bow.mu_C * rosin,
        mu_S=quantities.bow.mu_S * rosin,
        hair=float(by_chance.integers(MAX_HAIRS)),
    )
    body = _vary_body(quantities.body, factor)
    own = replace(quantities, string_1=strings[0], string_2=strings[1], bow=bow, body=body)
    return replace(calibration, tensions=(tensions[0], tensions[1])), own


def _vary_body(body: Body, factor: Callable[[float], float]) -> Body:
    """A body of another size, and with modes of its own."""
    size = factor(SIZE)
    return replace(
        body,
        frequency_hz=tuple(hertz * size * factor(MODE) for hertz in body.frequency_hz),
        mass=tuple(mass * factor(MASS) for mass in body.mass),
        damping=tuple(damping * factor(DAMPING) for damping in body.damping),
        sections=tuple(_move(section, size * factor(MODE)) for section in body.sections),
    )


def _move(
    section: tuple[float, float, float, float], factor: float
) -> tuple[float, float, float, float]:
    """Move a radiated mode to a frequency times a factor; its amplitude and phase stay."""
    b0, b1, a1, a2 = section
    radius, angle = pole_of(a1, a2)
    sine, cosine = sin_and_cos(angle)
    # The residue is (b0 pole + b1) / (pole - its conjugate); its real part is b0 / 2.
    imaginary = -0.5 * (b0 * radius * cosine + b1) / (radius * sine)
    moved_sine, moved_cosine = sin_and_cos(min(angle * factor, 0.99 * math.pi))
    return (
        b0,
        -2.0 * radius * (0.5 * b0 * moved_cosine + imaginary * moved_sine),
        -2.0 * radius * moved_cosine,
        radius * radius,
    )


def number_of_instruments(per_part: Sequence[PlayingOptions]) -> int:
    """How many instruments some parts take; raises ParameterError where a stage has fewer."""
    count = sum(map(section_size, per_part))
    if count > MAX_PARTS:
        raise ParameterError(f"{count} players, of all parts and sections: at most {MAX_PARTS}")
    return count


def seated(per_part: Sequence[PlayingOptions]) -> list[PlayingOptions]:
    """Options with a default pan and seed for each part; values that they set themselves win.

    They sit side by side from left to right, in the order of the parts; one alone in the middle.
    """
    own, number = [], 0
    step = 2.0 * WIDEST / max(len(per_part) - 1, 1)
    for part, playing in enumerate(per_part):
        place = (("/room/pan", part * step - WIDEST),) if len(per_part) > 1 else ()
        seed = (playing.seed + number) % SEEDS
        own.append(replace(playing, start=(*place, *playing.start), seed=seed))
        number += section_size(playing)
    return own


def assemble(
    per_part: Sequence[PlayingOptions],
    rate: float,
    tuned: Sequence[NoteTables],
    *,
    is_live: bool = True,
    **stage: Any,
) -> tuple[Ensemble, list[Sequence[Instrument]]]:
    """All parts' instruments on a `stage` (see `Ensemble`), and by part; `tuned`: calibrations."""
    specs: list[InstrumentSpec] = []
    ends = [0]
    for playing, calibration in zip(per_part, tuned, strict=True):
        specs += part_specs(playing, rate, calibration, number=len(specs))
        ends.append(len(specs))
    ensemble = Ensemble(specs, is_live=is_live, **stage)
    return ensemble, [ensemble.instruments[a:b] for a, b in pairwise(ends)]


def player_of(
    part: int, playing: PlayingOptions, instruments: Sequence[Instrument], *, delay_ms: float
) -> Player:
    """The player of a part, from 0, on all its instruments, `delay_ms` from message to sound."""
    instruments[0].delay = instruments[0].frames(delay_ms)
    return playing.mapped(playing.player(instruments, part))
