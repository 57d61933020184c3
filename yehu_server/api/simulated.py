"""A gesture to arrays: the model alone, in physical units."""

import os
import warnings
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from yehu_server.api.checks import PathLike, get_ready, number, path_of, whole
from yehu_server.core.physics.time_loop import advance, advance_with_ledger
from yehu_server.errors import ParameterError
from yehu_server.scores.gesture import Gesture, gesture_from, read_gesture, sample_rate
from yehu_server.simulation.run import Simulation, faults_of
from yehu_server.simulation.run import simulate as run

__all__ = ["Simulation", "gesture_of", "plain_gesture", "simulate"]

RATE = 44100.0


def simulate(
    gesture: Mapping[str, Any] | PathLike | Gesture,
    *,
    energy: bool = False,
    strings_every: int = 0,
    progress: Callable[[float, float], None] | None = None,
) -> Simulation:
    """Run the model with a gesture, and keep every signal.

    Parameters
    ----------
    gesture : mapping or path
        What a gesture file has (docs/simulate.md), or such a file. A control may be a number, a
        list of (time in s, value), or an array with a value for each sample. All such arrays have
        the same length; without a ``duration``, it is theirs.
    energy : bool
        Keep the energy ledger too.
    strings_every : int
        Keep the shapes of both strings every so many samples; 0 for never.
    progress : callable, optional
        Called with the seconds done and in all.

    Returns
    -------
    Simulation
        `arrays` has the signals by name, with a value for each sample: ``time`` (s), ``pressure``
        (Pa), ``bridge_force`` (N), ``bridge_velocity`` (m/s) and others (docs/simulate.md); `meta`
        what the run was.

    Raises
    ------
    YehuError
        Where the gesture is wrong, or makes no stable model.

    Warns
    -----
    RuntimeWarning
        Where friction was not solved at some samples, or the state was lost.

    Examples
    --------
    >>> import numpy as np, yehu_server as yehu
    >>> speed = 0.2 * np.minimum(np.arange(4410) / 2000, 1.0)
    >>> run = yehu.simulate({"controls": {"bow_force": 0.7, "bow_velocity": speed}}, energy=True)
    >>> run.arrays["bridge_force"].shape
    (4410,)
    >>> bool(np.abs(run.arrays["energy_error"]).max() < 1e-10 * run.arrays["power_in"].max())
    True
    """
    found = gesture_of(gesture)
    every = whole(strings_every, "strings_every", 0, 2**31)
    get_ready([advance_with_ledger if energy else advance])
    done = run(found, energy=bool(energy), strings_every=every, progress=progress)
    if faults := faults_of(done.meta):
        warnings.warn(faults, RuntimeWarning, stacklevel=2)
    return done


def gesture_of(gesture: Mapping[str, Any] | PathLike | Gesture) -> Gesture:
    """Return a gesture, checked; see `simulate`."""
    if isinstance(gesture, Gesture):
        return gesture
    if isinstance(gesture, Mapping):
        return gesture_from(plain_gesture(gesture))
    if isinstance(gesture, str | os.PathLike):
        return read_gesture(path_of(gesture, "gesture"))
    kind = type(gesture).__name__
    raise ParameterError(f"gesture: expected a mapping or the path of a file, got {kind}")


def plain_gesture(gesture: Mapping[str, Any]) -> dict[str, Any]:
    """Return the data of a gesture as a file has it: lists in place of arrays.

    Raises ParameterError where an array is no curve, or has another length than the gesture.
    """
    data = {name: _plain(value) for name, value in gesture.items() if name != "controls"}
    controls = gesture.get("controls", {})
    if not isinstance(controls, Mapping):
        raise ParameterError("controls: expected names and values")
    rate = data.get("sample_rate", RATE)
    arrays = {name: value for name, value in controls.items() if isinstance(value, np.ndarray)}
    sampled = {name: value for name, value in arrays.items() if value.ndim == 1 and len(value)}
    if sampled:
        data["duration"] = _duration(sampled, data.get("duration"), rate)
    data["controls"] = {
        name: _curve(value, rate) if name in sampled else _plain(value)
        for name, value in controls.items()
    }
    return data


def _duration(sampled: Mapping[str, NDArray[Any]], stated: Any, rate: Any) -> float:
    """How long a gesture lasts (s) whose controls have a value for each sample."""
    rate = sample_rate(rate)
    first, expected = next(iter(sampled)), len(next(iter(sampled.values())))
    which = f"{first} has {expected}"
    if stated is not None:
        expected = round(number(stated, "duration") * rate)
        which = f"{stated:g} s at {rate:g} Hz are {expected}"
    for name, values in sampled.items():
        if len(values) != expected:
            raise ParameterError(f"{name}: {len(values)} samples, but {which}")
    return float(stated) if stated is not None else expected / rate


def _curve(values: Any, rate: float) -> list[list[float]]:
    """Return a value for each sample as points of a curve."""
    times = np.arange(len(values)) / rate
    return np.stack([times, np.asarray(values, np.float64)], axis=1).tolist()  # type: ignore[no-any-return]


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    if isinstance(value, Mapping):
        return {name: _plain(each) for name, each in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(each) for each in value]
    return str(value) if isinstance(value, os.PathLike) else value
