"""Files in physical units: gestures, instruments, bodies."""

import dataclasses
import json
import math
from typing import Any

import numpy as np
from fuzz.target import target, words, written

from yehu_server.core.physics.default_quantities import read_body, read_quantities
from yehu_server.errors import ParameterError, ScoreError
from yehu_server.scores.gesture import Gesture, gesture_from, read_gesture

MAX_FRAMES = 50_000  # whose controls are worked out


def figures(thing: Any) -> list[float]:
    """All numbers in nested data classes and tuples."""
    if dataclasses.is_dataclass(thing):
        return [n for item in dataclasses.fields(thing) for n in figures(getattr(thing, item.name))]
    if isinstance(thing, tuple):
        return [number for part in thing for number in figures(part)]
    if isinstance(thing, str):  # a choice between words
        return []
    return [thing]


def check_quantities(quantities: Any) -> None:
    """Every quantity is within its bounds, and all is finite."""
    assert all(math.isfinite(number) for number in figures(quantities))
    for item in dataclasses.fields(quantities):
        value = getattr(quantities, item.name)
        if "lo" in item.metadata:
            lo, hi = item.metadata["lo"], item.metadata["hi"]
            assert all(lo <= number <= hi for number in figures(value)), item.name
        elif dataclasses.is_dataclass(value):
            check_quantities(value)


@target(
    "gesture",
    ScoreError,
    ParameterError,
    words=words(
        b'"sample_rate": |"duration": |"instrument": {|"controls": {|"bow_force": [[0, 1]]',
        b'"pluck": {"string": 1, "position": 0.1}|"hammer": [[0, 1]]|1e308|NaN|-1',
    ),
    also=("examples/gesture.json",),
)
def gesture(data: bytes) -> None:
    """A gesture has finite controls within their bounds and reads the same again, or is refused."""
    read = read_gesture(written(data, "file.json"))
    check_quantities(read.quantities)
    assert read.frames >= 1
    if read.frames <= MAX_FRAMES:
        assert np.isfinite(read.control_rows()).all()
    again = gesture_from(json.loads(json.dumps(read.source)), written(data, "file.json").parent)
    assert without_source(again) == without_source(read)


def without_source(read: Gesture) -> Gesture:
    return dataclasses.replace(read, source={})


@target(
    "instrument",
    ParameterError,
    words=words(
        b"[bow]\n|[string_1]\n|[finger]\n|T = |bridge_x = 0.3|epsilon_0 = 3e4|body = |1e999|nan"
    ),
)
def instrument(data: bytes) -> None:
    """An instrument file (TOML, or JSON where it begins with {) gives quantities in range."""
    ending = "json" if data[:1] == b"{" else "toml"
    check_quantities(read_quantities(written(data, f"instrument.{ending}")))


@target(
    "body",
    ParameterError,
    words=words(
        b'"bridge_modes": [|"frequency_hz": |"mass_kg": |"damping_kg_per_s": |"radiation": {',
        b'"sections": [|"direct_gain": |"sample_rate_hz": |1e308|NaN|Infinity',
    ),
    also=("yehu_server/core/physics/body.json",),
)
def body(data: bytes) -> None:
    """A body is passive and stable, of finite figures, or a ParameterError."""
    read = read_body(written(data, "body.json"))
    assert all(math.isfinite(number) for number in figures(read))
    assert min(*read.mass, *read.frequency_hz, read.radiation_rate) > 0.0
    assert min(read.damping) >= 0.0
    assert all(math.isfinite(omega) for omega in read.omega)
    for _, _, a1, a2 in read.sections:
        roots = np.roots([1.0, a1, a2])
        assert np.all(np.abs(roots) < 1.0)
