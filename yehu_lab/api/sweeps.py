"""Many gestures at once: how the model answers, with every combination of some values."""

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from numpy.typing import NDArray

from yehu_lab.regimes.strokes import bow_stroke
from yehu_lab.sweeps.result import Result as Sweep
from yehu_lab.sweeps.running import sweep as run_all
from yehu_lab.sweeps.study import study_of
from yehu_server.api.checks import PathLike, get_ready, number, whole
from yehu_server.api.simulated import gesture_of, plain_gesture
from yehu_server.errors import ParameterError
from yehu_server.scores.gesture import Gesture

__all__ = ["Sweep", "sweep"]

MAX_WORKERS = 1024
MAX_RUNS = 1_000_000


def sweep(
    gesture: Mapping[str, Any] | PathLike | Gesture,
    vary: Mapping[str, Sequence[float] | NDArray[Any]],
    *,
    workers: int | None = None,
    progress: Callable[[float, float], None] | None = None,
) -> Sweep:
    """Run a gesture with every combination of some values, on all cores.

    Parameters
    ----------
    gesture : mapping or path
        As of `simulate`. Bow and force begin at once, unless their curves say otherwise. Or strokes
        of notes: a mapping with a ``stroke``, as a study has it (docs/sweep.md), and with
        ``sample_rate``, ``duration`` and ``instrument`` if need be.
    vary : mapping
        Values by name: a control, such as ``bow_force``; ``bow_acceleration``, with which the bow
        begins from rest, up to its speed; or the path of another entry, such as
        ``instrument.bow.mu_S``. A curve is scaled, so that its largest point becomes the value. Of
        a stroke: ``note``, ``string``, ``position`` (beta), ``force``, ``speed`` and others.
    workers : int, optional
        Number of runs at a time; by default one for each core. The result is the same.
    progress : callable, optional
        Called with the number of runs done and of all.

    Returns
    -------
    Sweep

    Raises
    ------
    YehuError
        Where the gesture or a value is wrong, or there are too many runs.

    Examples
    --------
    >>> import yehu_server as yehu
    >>> gesture = {"duration": 0.3, "controls": {"bow_velocity": 0.2}}
    >>> found = yehu.sweep(gesture, {"bow_force": [0.02, 0.5], "bow_position": [0.25, 0.27]})
    >>> found.grid("regime").shape
    (2, 2)
    """
    axes = _axes(vary)
    if (count := math.prod(map(len, axes.values()))) > MAX_RUNS:
        raise ParameterError(
            f"{count} runs are more than {MAX_RUNS}; `yehu-server sweep` does any number"
        )
    if isinstance(gesture, Mapping) and "stroke" in gesture:
        study = study_of({**gesture, "vary": axes})
    elif isinstance(gesture, Mapping):
        study = study_of({"gesture": plain_gesture(gesture), "vary": axes})
    else:
        study = study_of({"gesture": dict(gesture_of(gesture).source), "vary": axes})
    most = None if workers is None else whole(workers, "workers", 1, MAX_WORKERS)
    get_ready([bow_stroke])
    return run_all(study, workers=most, progress=progress)


def _axes(vary: Any) -> dict[str, list[float]]:
    """Check the values that are varied."""
    if not vary or not isinstance(vary, Mapping):
        raise ParameterError("vary: expected names and values, such as {'bow_force': [0.2, 0.5]}")
    axes = {}
    for name, given in vary.items():
        if not isinstance(name, str) or not all(name.split(".")):
            raise ParameterError(f"vary: expected names, such as 'bow_force', got {name!r}")
        try:
            values = [number(value, name) for value in given]
        except TypeError:
            raise ParameterError(f"{name}: expected a list of numbers, got {given!r}") from None
        if not values:
            raise ParameterError(f"{name}: there are no values")
        axes[name] = values
    return axes
