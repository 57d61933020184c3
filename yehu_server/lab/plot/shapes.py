"""Pictures of the strings' shapes."""

from __future__ import annotations

from numbers import Real
from typing import TYPE_CHECKING, Any

import numpy as np

from yehu_server.errors import ParameterError
from yehu_server.lab.plot.axes import ABOVE, axes_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

INNER, OUTER, FINGER, BOW = "#1f5fa8", "0.35", "#c03a2b", "#e08a00"
LEAST_FORCE = 1e-3  # N; below, bow and fingers are lifted
MM = 1e3


def strings(simulation: Any, time: float, *, ax: Axes | None = None) -> Axes:
    """Draw the shapes of both strings at a moment, with bow, fingers and bridge.

    Parameters
    ----------
    simulation : Simulation
        With the strings kept: ``simulate(..., strings_every=10)``.
    time : float
        The moment (s); the nearest that was kept is drawn.
    ax : Axes, optional

    Returns
    -------
    Axes

    Raises
    ------
    ParameterError
        Where no strings were kept, the time is out of range, or matplotlib is missing.

    Examples
    --------
    >>> import yehu_server as yehu
    >>> controls = {"bow_force": 0.7, "bow_velocity": 0.3}
    >>> run = yehu.simulate({"duration": 0.1, "controls": controls}, strings_every=20)
    >>> yehu.plot.strings(run, 0.05).get_ylabel()
    'mm'
    """
    arrays = getattr(simulation, "arrays", {})
    if "strings_time" not in arrays:
        raise ParameterError("no shapes of strings were kept: simulate with strings_every=10")
    times = arrays["strings_time"]
    last = float(arrays["time"][-1])
    if not (isinstance(time, Real) and 0.0 <= time <= last):
        raise ParameterError(f"time: {time} s is not within 0 to {last:g} s")
    axes = axes_of(ax)
    row = int(np.abs(times - time).argmin())
    at = int(np.searchsorted(arrays["time"], times[row]).clip(max=len(arrays["time"]) - 1))
    for name, colour, label in (("1", INNER, "inner string"), ("2", OUTER, "outer string")):
        axes.plot(
            arrays[f"x_{name}"], MM * arrays[f"string_{name}"][row], color=colour, label=label
        )
    presses = np.atleast_1d(arrays["press_force"][at])
    places = np.atleast_1d(arrays["finger_position"][at])
    is_down = presses > LEAST_FORCE
    if is_down.any():
        heights = np.interp(places[is_down], arrays["x_1"], MM * arrays["string_1"][row])
        axes.plot(places[is_down], heights, "o", color=FINGER, ms=10, mfc="none", label="finger")
    if abs(arrays["bow_force"][at]) > LEAST_FORCE:
        axes.axvline(arrays["bow_position"][at], color=BOW, lw=1.2, label="bow")
    axes.plot(simulation.meta["bridge_x_m"], 0.0, "k^", ms=7, label="bridge")
    axes.set(xlabel="m from the loop", ylabel="mm")
    axes.text(0.02, 0.95, f"{times[row]:.4g} s", transform=axes.transAxes, va="top")
    axes.legend(**ABOVE, fontsize="small")
    return axes
