"""Arguments as users give them, checked; what playing needs, compiled; how to play by them."""

import logging
import math
import os
from collections.abc import Mapping, Sequence
from dataclasses import replace
from numbers import Integral, Real
from pathlib import Path
from typing import Any, Literal, Protocol

from yehu_server.compile.jit import Native
from yehu_server.core.engine.warming import CALLED, warm_up, what_compiles
from yehu_server.core.physics.default_quantities import Body, Quantities, override, read_quantities
from yehu_server.core.physics.grid import MAX_RATE, MIN_RATE
from yehu_server.errors import ParameterError
from yehu_server.params.table import HIGHEST_A4, LOWEST_A4, find, named, there_is
from yehu_server.playing.mapping import DEFAULT, load
from yehu_server.playing.options import PlayingOptions
from yehu_server.playing.preset_folders import Presets
from yehu_server.playing.tuning import EQUAL, RangePolicy, read_tuning
from yehu_server.util import values

log = logging.getLogger("yehu_server")


def get_ready(functions: Sequence[Native] = CALLED) -> None:
    """Warn, by `logging`, where some functions will be compiled; compile what playing needs.

    By default those that playing needs; others are compiled at their first use.
    """
    what = what_compiles(functions)
    if what is not None:
        log.warning("%s, once ...", what)
    if functions is CALLED:
        warm_up()


class HasBody(Protocol):
    """What has a body for the model, such as a ``yehu.body.Body``."""

    @property
    def body(self) -> Body:
        """What the model plays."""


PathLike = str | os.PathLike[str]
InstrumentLike = Quantities | Mapping[str, Any] | PathLike | HasBody


def number(
    value: Any, name: str, lo: float = -math.inf, hi: float = math.inf, unit: str = ""
) -> float:
    """Return a finite number within a range, also one of NumPy; raises ParameterError."""
    if isinstance(value, Real) and not isinstance(value, bool):
        value = int(value) if isinstance(value, Integral) else float(value)
    try:
        return values.number(value, lo, hi, unit)
    except ParameterError as error:
        raise ParameterError(f"{name}: {error}") from None


def rate_of(sample_rate: float) -> int:
    """Return a sample rate (Hz) that instruments have; raises ParameterError."""
    return whole(sample_rate, "sample_rate", MIN_RATE, MAX_RATE)


def whole(value: Any, name: str, lo: float, hi: float) -> int:
    """Return a whole number, also one of NumPy; see `number`."""
    found = number(value, name, lo, hi)
    if found != int(found):
        raise ParameterError(f"{name}: expected a whole number, got {values.brief(value)}")
    return int(found)


def setting(address: Any, value: Any) -> tuple[str, float]:
    """Return an address of the table, and a value within its range, which may have a name.

    Raises ParameterError.
    """
    if not isinstance(address, str):
        given = values.brief(address)
        raise ParameterError(f"address: expected one such as '/playing/vibrato', got {given}")
    param = find(address)
    if isinstance(value, str):
        return address, named(param, value)
    found = number(value, address, param.lo, param.hi, param.unit)
    return address, there_is(param, found)


def settings_of(settings: Mapping[str, float] | None) -> tuple[tuple[str, float], ...]:
    """Return addresses and values, checked; see `setting`."""
    if settings is not None and not isinstance(settings, Mapping):
        raise ParameterError(
            "settings: expected addresses and values, such as {'/body/blend': 0.5}"
        )
    return tuple(setting(address, value) for address, value in (settings or {}).items())


def quantities_of(instrument: InstrumentLike | None) -> Quantities:
    """Return the physical quantities of an instrument.

    Raises ParameterError where it is something else, or a quantity is unknown or out of range.

    `instrument` (Quantities, mapping, path, Body or None): a mapping of quantities to change, an
    instrument file (docs/physics.md), or a body of ``yehu.body``; None: the measured instrument.
    """
    if instrument is None:
        return Quantities()
    if isinstance(instrument, Quantities):
        return instrument
    if isinstance(instrument, Mapping):
        return override(Quantities(), instrument)
    body = getattr(instrument, "body", None)
    if isinstance(body, Body):
        return Quantities(body=body)
    return read_quantities(path_of(instrument, "instrument"))


def name_of(value: Any, what: str) -> str:
    """Return a name or a path as text; raises ParameterError where it is neither."""
    if not isinstance(value, str | os.PathLike):
        several = "; several with a plus: 'sul-tasto+hall'" if what == "preset" else ""
        brief = values.brief(value)
        raise ParameterError(f"{what}: expected a name or a path, got {brief}{several}")
    return os.fspath(value)


def path_of(value: Any, name: str) -> Path:
    """Return a path; raises ParameterError where it is none."""
    return Path(name_of(value, name))


OutOfRange = Literal["transpose", "clamp", "skip"]


def playing_of(
    instrument: InstrumentLike | None,
    *,
    preset: PathLike | None,
    settings: Mapping[str, float] | None,
    a4: float,
    tuning: PathLike | None,
    practice: PathLike | None,
    seed: int,
    mapping: PathLike = DEFAULT,
    out_of_range: OutOfRange = "transpose",
) -> PlayingOptions:
    """Check options, and read the files that they name; see `render`. Raises YehuError."""
    policies = [policy.value for policy in RangePolicy]
    if out_of_range not in policies:
        raise ParameterError(f"out_of_range: {out_of_range!r} is not one of {', '.join(policies)}")
    playing = PlayingOptions(
        mapping=load(name_of(mapping, "mapping"), user_first=False),
        presets=Presets(user_first=False),
        settings=settings_of(settings),
        a4=number(a4, "a4", LOWEST_A4, HIGHEST_A4),
        tuning=EQUAL if tuning is None else read_tuning(path_of(tuning, "tuning")),
        policy=RangePolicy(out_of_range),
        seed=whole(seed, "seed", 0, find("/engine/seed").hi),
    )
    if preset is not None:
        playing = playing.with_preset(name_of(preset, "preset"))
    own = None if practice is None else path_of(practice, "practice")
    if isinstance(instrument, str | os.PathLike):
        return playing.on_instrument(Path(instrument), own)
    return replace(playing, quantities=quantities_of(instrument)).on_instrument(None, own)
