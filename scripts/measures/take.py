"""Performances to measure: one instrument, one mapping, messages at times."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from typing import Any

import mido
import numpy as np

from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.rig import RIG
from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.core.player.note_tables import NoteTables, wave_speed
from yehu_server.params.table import FINGERS, find
from yehu_server.playing.calibration_store import calibration_for
from yehu_server.playing.mapping import DEFAULT, load
from yehu_server.playing.options import PlayingOptions
from yehu_server.playing.part_state import Key
from yehu_server.playing.preset_folders import Presets
from yehu_server.playing.stringing import notes_of

NOTES = range(65, 90)  # F4 to F6
SEEDS = 65536
MEAN_FROM_S = 0.4
Sound = Any


@dataclass(frozen=True)
class Setup:
    """What all takes of a measure have in common.

    `rate`: sample rate (Hz).
    `variation`: `/playing/variation`.
    `seed`: of all that is left to chance.
    `way`: the only way of bowing that is measured (`shuffled`).
    `own`: the instrument before it is tuned.
    `bowing`: A bowing table; by default that which comes with the program.
    `phrasing`: `/playing/phrasing`.
    """

    rate: float
    variation: float = 0.0
    seed: int = 0
    way: str | None = None
    own: Quantities = field(default_factory=Quantities)
    bowing: Any = None
    phrasing: float = 0.0

    @property
    def calibration(self) -> NoteTables:
        """That of the instrument, bowed so."""
        return calibration_for(self.rate, self.own, bowing=self.bowing)

    @property
    def notes(self) -> range:
        """The notes that the instrument has, such as F4 to F6 of a yehu."""
        lowest, highest = notes_of(self.own).ends
        return range(lowest, highest + 1)

    def steady_s(self, usual_s: float) -> float:
        """Return when the steady state begins (s): under variation the mean from 0.4 s counts."""
        return usual_s if self.variation == 0.0 else MEAN_FROM_S

    def of_job(self, number: int) -> Setup:
        """Return the setup of one of many takes, whose notes vary otherwise than the others'."""
        return replace(self, seed=(1000 * self.seed + number) % SEEDS)


def _believe(instrument: Instrument, quantities: Quantities) -> None:
    """Let the player of an instrument take its strings for those of other quantities."""
    player = np.frombuffer(instrument.memory, RIG, count=1)["player"]
    player["wave_speed"] = [wave_speed(quantities, i) for i in range(len(quantities.strings))]


class Take:
    """One performance on one instrument.

    `settings`: held values of parameters, by address.
    `quantities`: another instrument before it is tuned; it has the calibration of that of the
    setup.
    `tension`: factor on the tension of both strings, of which the player does not know.
    """

    def __init__(
        self,
        setup: Setup,
        preset: str = "ordinary",
        *,
        mapping: str = DEFAULT,
        settings: Mapping[str, float] | None = None,
        quantities: Quantities | None = None,
        tension: float = 1.0,
    ) -> None:
        self.rate = setup.rate
        start = tuple(Presets().load(preset).values.items()) if mapping == DEFAULT else ()
        quantities = quantities or setup.own
        how = {"seed": setup.seed, "bowing": setup.bowing, "quantities": quantities}
        playing = PlayingOptions(start=start, mapping=load(mapping), **how)
        usual = setup.calibration
        first, second = usual.tensions
        strung = replace(usual, tensions=(tension * first, tension * second))
        self.instrument = Instrument(playing.spec(setup.rate, strung))
        _believe(self.instrument, usual.tuned(quantities))
        self.player = playing.player(self.instrument)
        self.player.write("/playing/variation", setup.variation, frame=0, hold=True)
        self.player.write("/playing/phrasing", setup.phrasing, frame=0, hold=True)
        playing.mapped(self.player)
        self._channel = 1 if playing.mapping.mpe else 0  # a member of the zone
        for address, value in (settings or {}).items():
            self.player.write(address, value, frame=0, hold=True)

    def _frame(self, seconds: float) -> int:
        return self.instrument.frames(1e3 * seconds)

    def at(self, seconds: float, kind: str, **fields: int) -> None:
        """Schedule a MIDI message for a time."""
        message = mido.Message(kind, channel=self._channel, **fields)
        self.player.receive(message, frame=self._frame(seconds))

    def on(self, seconds: float, note: float, velocity: int = 80) -> None:
        """Schedule the beginning of a note, which may be fractional."""
        self.player.key_on(Key(self._channel, note), velocity, frame=self._frame(seconds))

    def off(self, seconds: float, note: float) -> None:
        """Schedule the end of a note."""
        self.player.key_off(Key(self._channel, note), frame=self._frame(seconds))

    def long(self, seconds: float, length_s: float) -> None:
        """Set how long the note will be that begins at a time, as files do."""
        address = "/playing/note_length"
        self.player.write(address, length_s, frame=self._frame(seconds))

    def wheel(self, place: int | None) -> None:
        """Set the bow speed, by its controller, before the first note; None leaves it untouched."""
        if place is not None:
            self.at(0.0, "control_change", control=16, value=place)

    def play(self, seconds: float) -> Sound:
        """Return the sound of the performance."""
        out = np.zeros(self._frame(seconds), np.float32)
        self.instrument.process(out)
        return out

    def finger_m(self) -> float:
        """Return the position (m) of the finger that is down; NaN where none is."""
        for finger in FINGERS:
            if self.instrument.target(f"/finger/{finger}/press") > 0.0:
                return self.instrument.target(f"/finger/{finger}/position")
        return math.nan

    @property
    def is_at_nut(self) -> bool:
        """Whether the finger is as near to the nut (the loop) as it can be."""
        return self.finger_m() <= find("/finger/1/position").lo


def held(
    setup: Setup, note: float, velocity: int, seconds: float, wheel: int | None = None, **how: Any
) -> tuple[Sound, Take]:
    """Play a note alone, with the controller of bow speed at a place; `how` is as of `Take`."""
    take = Take(setup, **how)
    take.wheel(wheel)
    take.on(0.0, note, velocity)
    return take.play(seconds), take


def in_parallel(setup: Setup, work: Callable[..., Any], jobs: Iterable[Sequence[Any]]) -> list[Any]:
    """Run jobs in threads, each with a setup of its own, and return their results.

    The model runs without the GIL.
    """
    setups = ((setup.of_job(i), *job) for i, job in enumerate(jobs))
    with ThreadPoolExecutor(os.cpu_count()) as workers:
        return list(workers.map(lambda job: work(*job), setups))
