"""How to play, from the options that `Instrument` and `render` share."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from yehu_server.api.checks import (
    InstrumentLike,
    PathLike,
    name_of,
    number,
    path_of,
    quantities_of,
    settings_of,
    whole,
)
from yehu_server.core.physics.grid import HIGHEST_RATE, LOWEST_RATE
from yehu_server.core.physics.quantities import Quantities
from yehu_server.errors import ParameterError
from yehu_server.params.table import find
from yehu_server.playing.mapping import DEFAULT, load
from yehu_server.playing.options import PlayingOptions
from yehu_server.playing.practice_files import read_practice
from yehu_server.playing.preset_folders import Presets
from yehu_server.playing.tuning import EQUAL, RangePolicy, read_tuning

OutOfRange = Literal["transpose", "clamp", "skip"]
LOWEST_A4, HIGHEST_A4 = 390.0, 480.0  # Hz; as of --a4


@dataclass(frozen=True)
class PlayingSetup:
    """What instrument is played, and how."""

    sample_rate: int
    quantities: Quantities
    playing: PlayingOptions


def playing_setup_of(
    sample_rate: float,
    instrument: InstrumentLike | None,
    *,
    preset: PathLike | None = None,
    settings: Mapping[str, float] | None = None,
    a4: float = 440.0,
    tuning: PathLike | None = None,
    practice: PathLike | None = None,
    seed: int = 0,
    mapping: PathLike = DEFAULT,
    out_of_range: OutOfRange = "transpose",
) -> PlayingSetup:
    """Check options, and read the files that they name; see `render`.

    Raises
    ------
    YehuError
        Where one is wrong.
    """
    rate = whole(sample_rate, "sample_rate", LOWEST_RATE, HIGHEST_RATE)
    presets = Presets(user_first=False)
    file = None
    start: tuple[tuple[str, float], ...] = ()
    if preset is not None:
        name = name_of(preset, "preset")
        file, start = presets.find_file(name), tuple(presets.find(name).values.items())
    policies = [policy.value for policy in RangePolicy]
    if out_of_range not in policies:
        raise ParameterError(f"out_of_range: {out_of_range!r} is not one of {', '.join(policies)}")
    most = find("/engine/seed").hi
    playing = PlayingOptions(
        mapping=load(name_of(mapping, "mapping"), user_first=False),
        presets=presets,
        preset=file,
        start=start,
        settings=settings_of(settings),
        a4=number(a4, "a4", LOWEST_A4, HIGHEST_A4),
        tuning=EQUAL if tuning is None else read_tuning(path_of(tuning, "tuning")),
        policy=RangePolicy(out_of_range),
        seed=whole(seed, "seed", 0, most),
        bowing=None if practice is None else read_practice(path_of(practice, "practice")),
        practice=None if practice is None else path_of(practice, "practice"),
    )
    quantities = quantities_of(instrument)
    return PlayingSetup(rate, quantities, playing.for_instrument(quantities))
