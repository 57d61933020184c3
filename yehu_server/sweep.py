"""One gesture run again and again with other figures, on all cores: for whoever studies the model.

The files are described in docs/simulate.md.
"""

from __future__ import annotations

import copy
import itertools
import json
import math
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from yehu_server.analysis.pitch import pitch_hz
from yehu_server.errors import OutputError, ParameterError
from yehu_server.files import write_text
from yehu_server.score.gesture import CONTROLS, Gesture, gesture_from
from yehu_server.simulate import Simulation, simulate

MOST_RUNS = 100_000
INDEX = "index.json"


@dataclass(frozen=True)
class Axis:
    """What is varied: an entry of a gesture file by its path, and the values it takes."""

    path: tuple[str, ...]
    values: tuple[float, ...]

    @property
    def name(self) -> str:
        """The path as it is written."""
        return ".".join(self.path[1:] if self.path[0] == "controls" else self.path)

    def vary(self, data: Any, value: float) -> None:
        """Put a value into the data of a gesture file, in place.

        A control that is a curve keeps its shape: its largest point becomes the value.
        Errors: ParameterError where the path is none.
        """
        *way, last = self.path
        for name in way:
            data = data.setdefault(name, {}) if isinstance(data, dict) else None
        if not isinstance(data, dict):
            raise ParameterError(f"{self.name}: no such entry")
        present = data.get(last)
        data[last] = _scaled(present, value) if isinstance(present, list) else value


def axis_of(text: str) -> Axis:
    """Read ``NAME=V1,V2,...`` or ``NAME=FROM:TO:STEPS``. Errors: ParameterError."""
    name, equals, values = text.partition("=")
    path = tuple(name.strip().split("."))
    if not equals or not all(path):
        raise ParameterError(f"{text!r}: expected NAME=V1,V2,... or NAME=FROM:TO:STEPS")
    if path[0] in CONTROLS:
        path = ("controls", *path)
    try:
        if values.count(":") == 2:
            first, last, steps = values.split(":")
            spread = np.linspace(float(first), float(last), _steps(steps))
            return Axis(path, tuple(float(value) for value in spread))
        return Axis(path, tuple(float(value) for value in values.split(",")))
    except ValueError:
        raise ParameterError(f"{text!r}: expected numbers after {name}=") from None


def variations(
    source: Mapping[str, Any], axes: Sequence[Axis], folder: Path = Path()
) -> list[tuple[dict[str, float], Gesture]]:
    """Every combination of the axes' values, the last one changing fastest.

    Parameters
    ----------
    source : mapping
        The data of a gesture file in `folder`.

    Returns the values by name, and the gesture with them. Errors: ParameterError.
    """
    count = math.prod(len(axis.values) for axis in axes)
    if count > MOST_RUNS:
        raise ParameterError(f"{count} runs are more than {MOST_RUNS}")
    found = []
    for values in itertools.product(*(axis.values for axis in axes)):
        data = copy.deepcopy(dict(source))
        for axis, value in zip(axes, values, strict=True):
            axis.vary(data, value)
        named = {axis.name: value for axis, value in zip(axes, values, strict=True)}
        found.append((named, gesture_from(data, folder)))
    return found


def sweep(
    runs: Sequence[tuple[dict[str, float], Gesture]],
    folder: Path,
    *,
    energy: bool = False,
    strings_every: int = 0,
    keep: bool = True,
    workers: int | None = None,
    progress: Callable[[float, float], None] | None = None,
) -> list[dict[str, Any]]:
    """Run gestures on several cores; write their arrays and an index into a folder.

    Parameters
    ----------
    energy, strings_every
        As of `simulate`.
    keep : bool
        Whether the arrays are written, beside the index.
    workers : int
        How many run at a time; as many as there are cores by default.
    progress : callable
        Told runs done, and all runs.

    Returns the rows of the index: what was varied, the file, and what came of it.
    Errors: OutputError.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(f"{folder}: {error.strerror}") from error
    width = len(str(len(runs) - 1))

    def run(number: int) -> dict[str, Any]:
        varied, gesture = runs[number]
        result = simulate(gesture, energy=energy, strings_every=strings_every)
        row: dict[str, Any] = {"varied": varied} | findings(result)
        if keep:
            row["file"] = f"{number:0{width}}.npz"
            result.save(folder / row["file"])
        return row

    rows = []
    # The model runs without the GIL, so threads are enough.
    with ThreadPoolExecutor(workers or os.cpu_count()) as pool:
        for row in _in_order(pool, run, len(runs)):
            rows.append(row)
            if progress is not None:
                progress(len(rows), len(runs))
    write_text(folder / INDEX, json.dumps(rows, indent=1) + "\n")
    return rows


def findings(result: Simulation) -> dict[str, Any]:
    """What a run came to: pitch and level of its second half, and what went wrong."""
    pressure = result.arrays["pressure"]
    half = pressure[len(pressure) // 2 :]
    swing = half - half.mean() if len(half) else half
    pitch = pitch_hz(swing, float(result.meta["sample_rate"]))
    return {
        "pitch_hz": pitch if math.isfinite(pitch) else None,
        "pressure_rms": float(np.sqrt(np.mean(np.square(swing)))) if len(swing) else 0.0,
        "unconverged_solves": result.meta["unconverged_solves"],
        "lost_states": result.meta["lost_states"],
    }


def _in_order(
    pool: ThreadPoolExecutor, run: Callable[[int], dict[str, Any]], count: int
) -> Iterator[dict[str, Any]]:
    try:
        yield from pool.map(run, range(count))
    except BaseException:  # an interrupt, or one that fails: the others need not run
        pool.shutdown(cancel_futures=True)
        raise


def _steps(text: str) -> int:
    steps = int(text)
    if not 2 <= steps <= MOST_RUNS:
        raise ParameterError(f"{text} steps: 2 to {MOST_RUNS} are possible")
    return steps


def _scaled(curve: list[Any], value: float) -> list[Any]:
    try:
        largest = max((level for _, level in curve), key=abs)
        return [[time, level * value / largest] for time, level in curve]
    except (TypeError, ValueError, ZeroDivisionError):
        raise ParameterError("a curve that is varied needs a point that is not 0") from None
