"""Reads the description of a data set; docs/dataset.md describes the format."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from yehu_server.core.physics.grid import check_rate
from yehu_server.core.physics.quantities import Quantities, override
from yehu_server.errors import ParameterError, YehuError
from yehu_server.lab.dataset.draws import Distribution, chance, number, read_distribution, shares_of
from yehu_server.params.table import find
from yehu_server.playing.calibration import calibration_key
from yehu_server.scores.gesture import CONTROLS
from yehu_server.util.documents import parse_toml
from yehu_server.util.files import MAX_SETTINGS_BYTES, PLAIN_NAME, read_text, why

ENTRIES = ("about", "kind", "count", "seed", "sample_rate", "split", "draw", "keep", "instrument")
A4 = 440.0  # Hz
KINDS = ("strokes", "notes")
MOST_SOUNDS = 10_000_000
LONGEST_S = 60.0  # of one sound
MOST_NOTES = 32
COUNTS = ("string", "notes")

# By kind: each value that may be drawn, its default, and its bounds.
STROKES = {
    "duration": (0.5, 0.05, LONGEST_S),  # s
    "string": (1.0, 1.0, 2.0),
    "stop": (0.0, 0.0, 24.0),  # semitones above the open string
    "stop_end": (None, 0.0, 24.0),
    "bow_velocity": (0.2, -CONTROLS["bow_velocity"].hi, CONTROLS["bow_velocity"].hi),  # m/s
    "bow_velocity_end": (None, -CONTROLS["bow_velocity"].hi, CONTROLS["bow_velocity"].hi),
    "bow_force": (0.7, 0.0, CONTROLS["bow_force"].hi),  # N
    "bow_force_end": (None, 0.0, CONTROLS["bow_force"].hi),
    "bow_position": (0.12, 0.01, 0.5),  # share of the sounding length, from the bridge
    "bow_position_end": (None, 0.01, 0.5),
    "bow_noise": (0.0, 0.0, 1.0),
    "press_force": (1.5, 0.0, 20.0),  # N
    "attack": (0.03, 0.0, 10.0),  # s
    "force_attack": (0.01, 0.0, 10.0),
}
NOTES = {
    "notes": (1.0, 1.0, float(MOST_NOTES)),
    "pitch": (69.0, 65.0, 89.0),  # fractional MIDI notes
    "velocity": (80.0, 1.0, 127.0),
    "length": (0.5, 0.05, LONGEST_S),  # s
    "gap": (0.05, -1.0, 10.0),  # s; below 0 the next note is slurred
    "tail": (0.3, 0.0, 10.0),  # s
}
SIGNALS = (
    "bridge_force",
    "bridge_force_1",
    "bridge_force_2",
    "bridge_velocity",
    "pressure",
    "friction_force",
    "relative_velocity",
    "finger_displacement",
    "contact_force",
)


@dataclass(frozen=True)
class Description:
    """What a data set is made of.

    Attributes
    ----------
    kind : str
        Of KINDS.
    draws : mapping
        Of each value, by name; for notes, also parameters by their addresses.
    splits : tuple of (name, share)
        The shares are sums: the last is 1.
    every : int
        Samples between two that are kept of each control.
    signals : tuple of str
        Of SIGNALS, kept at each sample.
    quantities : Quantities
        The instrument before it is tuned.
    key : str
        Hash of all that a sound depends on beside the code; how many there are is no part of it.
    """

    kind: str
    count: int
    seed: int
    rate: float
    draws: Mapping[str, Distribution]
    splits: tuple[tuple[str, float], ...]
    every: int
    signals: tuple[str, ...]
    quantities: Quantities
    key: str

    def drawn(self, number: int) -> dict[str, float]:
        """The values of a sound, by name."""
        return {name: self.draw(number, name) for name in sorted(self.draws)}

    def draw(self, number: int, name: str, again: int = 0) -> float:
        """A value of a sound; `again` counts those of one name, such as of several notes."""
        share = chance(self.seed, number, f"{name}/{again}" if again else name)
        return self.draws[name].value(share)

    def split(self, number: int) -> str:
        """The split that a sound is in."""
        share = chance(self.seed, number, "split")
        return next(name for name, upto in self.splits if share < upto)


def read_description(path: Path) -> Description:
    """Read the description of a data set.

    Raises
    ------
    ParameterError
        Naming the file and the entry.
    """
    try:
        data = parse_toml(read_text(path, MAX_SETTINGS_BYTES))
        return description_of(data, path.parent)
    except OSError as error:
        raise ParameterError(f"{path}: {why(error)}") from error
    except UnicodeDecodeError as error:
        raise ParameterError(f"{path}: is not text") from error
    except (ValueError, YehuError) as error:
        raise ParameterError(f"{path}: {error}") from error


def description_of(data: Mapping[str, Any], folder: Path = Path()) -> Description:
    """Check the data of a description, which is in a folder.

    Raises
    ------
    ParameterError
        Naming the entry.
    """
    _known(data, "", ENTRIES)
    kind = data.get("kind", "strokes")
    if kind not in KINDS:
        raise ParameterError(f"kind: {' or '.join(KINDS)}, not {kind!r}")
    rate = number(data.get("sample_rate", 44100), "sample_rate")
    check_rate(rate)
    keep = _table(data, "keep")
    _known(keep, "keep.", ("every", "signals"))
    signals = keep.get("signals", [])
    if not isinstance(signals, list) or not all(each in SIGNALS for each in signals):
        raise ParameterError(f"keep.signals: a list of {', '.join(SIGNALS)}")
    quantities = override(Quantities(), _table(data, "instrument"), folder)
    count = _whole(data.get("count", 100), "count", 1, MOST_SOUNDS)
    seed = _whole(data.get("seed", 0), "seed", 0, 2**63 - 1)
    body = calibration_key(rate, quantities, A4)  # files that are named may change
    text = json.dumps({**data, "count": 0, "about": ""}, sort_keys=True, default=str)
    return Description(
        kind=kind,
        count=count,
        seed=seed,
        rate=rate,
        draws=_draws(_table(data, "draw"), kind),
        splits=_splits(_table(data, "split") or {"train": 1.0}),
        every=_whole(keep.get("every", 64), "keep.every", 1, 1 << 20),
        signals=tuple(signals),
        quantities=quantities,
        key=hashlib.sha256(f"{text}{body}".encode()).hexdigest(),
    )


def _draws(entries: Mapping[str, Any], kind: str) -> dict[str, Distribution]:
    known = STROKES if kind == "strokes" else NOTES
    defaults = {name: default for name, (default, _, _) in known.items() if default is not None}
    draws: dict[str, Distribution] = {}
    for name, entry in {**defaults, **entries}.items():
        draw = read_distribution(entry, f"draw.{name}")
        lo, hi = _bounds(name, kind, known)
        if not lo <= draw.ends[0] <= draw.ends[1] <= hi:
            raise ParameterError(f"draw.{name}: within {lo:g} to {hi:g}")
        if name in COUNTS and not draw.is_whole:
            raise ParameterError(f'draw.{name}: whole numbers only, such as spacing = "whole"')
        draws[name] = draw
    return draws


def _bounds(
    name: str, kind: str, known: Mapping[str, tuple[float | None, float, float]]
) -> tuple[float, float]:
    """The bounds of a value.

    Raises
    ------
    ParameterError
        Where there is no such value.
    """
    if name in known:
        return known[name][1:]
    if kind == "notes" and name.startswith("/playing/"):
        param = find(name)
        return param.lo, param.hi
    more = ", or an address of /playing" if kind == "notes" else ""
    raise ParameterError(f"draw: unknown name {name!r} (known: {', '.join(known)}{more})")


def _splits(entries: Mapping[str, Any]) -> tuple[tuple[str, float], ...]:
    for name in entries:
        if not PLAIN_NAME.fullmatch(name):
            raise ParameterError(f"split: {name!r} is no plain name for a folder")
    if len({name.casefold() for name in entries}) < len(entries):
        raise ParameterError("split: names that differ in more than capitals")
    weights = [number(value, f"split.{name}") for name, value in entries.items()]
    return tuple(zip(entries, shares_of(weights, "split"), strict=True))


def _known(table: Mapping[str, Any], where: str, names: tuple[str, ...]) -> None:
    for name in table:
        if name not in names:
            raise ParameterError(f"{where}{name}: unknown name (known: {', '.join(names)})")


def _table(data: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    table = data.get(name, {})
    if not isinstance(table, dict):
        raise ParameterError(f"{name}: expected a table")
    return table


def _whole(value: Any, where: str, lo: int, hi: int) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or not lo <= value <= hi:
        raise ParameterError(f"{where}: a whole number from {lo} to {hi}, not {value!r}")
    return value
