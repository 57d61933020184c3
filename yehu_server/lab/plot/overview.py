"""Pictures of a whole simulation or sweep, in one call."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from yehu_server.errors import ParameterError
from yehu_server.lab.labels import label_of
from yehu_server.lab.plot.study import plane_of
from yehu_server.lab.plot.sweep_maps import (
    ACCELERATION,
    FORCE,
    PLACE,
    At,
    guettler,
    regimes,
    schelleng,
)
from yehu_server.lab.sweeps.result import Result
from yehu_server.util.extras import need

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

USUAL = ("bridge_force", "relative_velocity", "friction_force", "pressure")
WIDTH, HEIGHT = 9.0, 1.7  # inches, of each signal


def signals(
    simulation: Any,
    *names: str,
    start: float = 0.0,
    end: float | None = None,
    figure: Figure | None = None,
) -> Figure:
    r"""Draw signals of a simulation, one below another.

    Parameters
    ----------
    simulation : Simulation
    names : str
        Of its arrays with a value for each sample; by default the forces of bridge and hair, the
        velocity of the string on the hair, and the pressure.
    start, end : float
        The part to draw (s); by default all.
    figure : Figure, optional
        By default a new one.

    Returns
    -------
    Figure

    Raises
    ------
    ParameterError
        Where there is no such array, or matplotlib is missing.

    Examples
    --------
    >>> import yehu_server as yehu
    >>> run = yehu.simulate({"duration": 0.1, "controls": {"bow_force": 0.7, "bow_velocity": 0.3}})
    >>> figure = yehu.plot.signals(run, "bridge_force", "bridge_velocity", start=0.05)
    >>> [ax.get_ylabel() for ax in figure.axes]
    ['bridge force\nN', 'bridge velocity\nm/s']
    """
    arrays = getattr(simulation, "arrays", {})
    shown = names or USUAL
    frames = len(arrays.get("time", ()))
    known = [name for name, values in arrays.items() if len(values) == frames and name != "time"]
    for name in shown:
        if name not in known:
            raise ParameterError(f"there is no signal {name!r} (there are: {', '.join(known)})")
    need("matplotlib", "yehu.plot", "plots")
    if figure is None:
        import matplotlib.pyplot as plt

        figure = plt.figure(figsize=(WIDTH, HEIGHT * len(shown) + 0.5), layout="constrained")
    time = arrays["time"]
    part = (time >= start) & (time <= (time[-1] if end is None else end))
    panels = figure.subplots(len(shown), 1, sharex=True, squeeze=False)[:, 0]
    for ax, name in zip(panels, shown, strict=True):
        ax.plot(time[part], arrays[name][part].reshape(int(part.sum()), -1), lw=0.8)
        unit = label_of(name).unit.replace("m s-1", "m/s")
        ax.set_ylabel(f"{name.replace('_', ' ')}\n{unit}")
        ax.margins(x=0.0)
    panels[-1].set_xlabel("s")
    return figure


def sweep(sweep: Result, *, at: At | None = None, ax: Axes | None = None) -> Axes:
    """Draw the map of a sweep: Schelleng's or Guettler's diagram where it has their axes.

    Parameters
    ----------
    sweep : Sweep
        Of two axes at least; any two make a map of the motion.
    at, ax
        As of `regimes`.

    Returns
    -------
    Axes

    Raises
    ------
    ParameterError
        Where it has one axis only, another is varied and not told, or matplotlib is missing.

    Examples
    --------
    >>> import yehu_server as yehu
    >>> gesture = {"duration": 0.2, "controls": {"bow_velocity": 0.2}}
    >>> found = yehu.sweep(gesture, {"bow_position": [0.22, 0.26, 0.28], "bow_force": [0.2, 1.0]})
    >>> yehu.plot.sweep(found).get_xlabel()
    'bow position β'
    """
    has_force = any(name in sweep.axes for name in FORCE)
    free = {name: len(values) for name, values in sweep.axes.items() if name not in (at or {})}
    if has_force and any(name in free for name in PLACE):
        return schelleng(sweep, at=at, ax=ax)
    if has_force and any(name in free for name in ACCELERATION):
        return guettler(sweep, at=at, ax=ax)
    x, y = plane_of(free)
    if y is None:
        raise ParameterError("the sweep has one axis only: a map needs two")
    return regimes(sweep, x, y, at=at, ax=ax)
