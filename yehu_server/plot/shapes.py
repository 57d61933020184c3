"""Pictures of a simulation: its signals, the strings' shapes, and the energy ledger."""

from __future__ import annotations

from numbers import Real
from typing import TYPE_CHECKING, Any

import numpy as np

from yehu_server.errors import ParameterError, did_you_mean
from yehu_server.plot.axes import ABOVE, axes_of, figure_of
from yehu_server.simulation.labels import label_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

INNER, OUTER, FINGER, BOW = "#1f5fa8", "0.35", "#c03a2b", "#e08a00"
MM = 1e3
USUAL = ("bridge_force", "relative_velocity", "friction_force", "pressure")
WIDTH, HEIGHT = 9.0, 1.7  # inches, of each signal
LOSSES = {
    "loss_friction": ("friction of the hair", "#e08a00"),
    "loss_strings": ("strings", "#1f5fa8"),
    "loss_bridge": ("body", "#3f9b57"),
    "loss_finger": ("finger", "#c03a2b"),
    "loss_hair": ("hair", "#8a6bb1"),
}
LEFT_OUT = ("loss_bow_lift", "loss_contact_reset")  # as a bow or a finger leaves
STORED = "0.8"
MJ = 1e3


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
            there = f"(there are: {', '.join(known)}){did_you_mean(name, known)}"
            raise ParameterError(f"there is no signal {name!r} {there}")
    time = arrays["time"]
    part = (time >= start) & (time <= (time[-1] if end is None else end))
    if not part.any():
        raise ParameterError(f"start, end: nothing is there; it lasts {max(time, default=0):.4g} s")
    figure = figure_of(figure, WIDTH, HEIGHT * len(shown) + 0.5)
    panels = figure.subplots(len(shown), 1, sharex=True, squeeze=False)[:, 0]
    for ax, name in zip(panels, shown, strict=True):
        ax.plot(time[part], arrays[name][part].reshape(int(part.sum()), -1), lw=0.8)
        unit = label_of(name).unit.replace("m s-1", "m/s")
        ax.set_ylabel(f"{name.replace('_', ' ')}\n{unit}")
        ax.margins(x=0.0)
    panels[-1].set_xlabel("s")
    return figure


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
    lift_force = simulation.meta["instrument"]["bow"]["lift_force"]
    is_down = presses > lift_force
    if is_down.any():
        heights = np.interp(places[is_down], arrays["x_1"], MM * arrays["string_1"][row])
        axes.plot(places[is_down], heights, "o", color=FINGER, ms=10, mfc="none", label="finger")
    if abs(arrays["bow_force"][at]) > lift_force:
        axes.axvline(arrays["bow_position"][at], color=BOW, lw=1.2, label="bow")
    axes.plot(simulation.meta["bridge_x_m"], 0.0, "k^", ms=7, label="bridge")
    axes.set(xlabel="m from the loop", ylabel="mm")
    axes.text(0.02, 0.95, f"{times[row]:.4g} s", transform=axes.transAxes, va="top")
    axes.legend(**ABOVE, fontsize="small")
    return axes


def energy(simulation: Any, *, ax: Axes | None = None) -> Axes:
    """Draw the energy balance: what bow, finger and hammer gave, and where it is.

    What was stored and lost is stacked; its upper edge lies on the line of what was given, and
    the title states the largest power that is missing.

    Parameters
    ----------
    simulation : Simulation
        With the energy ledger: ``simulate(..., energy=True)``.
    ax : Axes, optional

    Returns
    -------
    Axes

    Raises
    ------
    ParameterError
        Where there is no ledger, or matplotlib is missing.

    Examples
    --------
    >>> import yehu_server as yehu
    >>> controls = {"bow_force": 0.7, "bow_velocity": 0.3}
    >>> run = yehu.simulate({"duration": 0.1, "controls": controls}, energy=True)
    >>> yehu.plot.energy(run).get_ylabel()
    'mJ'
    """
    arrays = getattr(simulation, "arrays", {})
    if "power_in" not in arrays:
        raise ParameterError("no energy was kept: simulate with energy=True")
    axes = axes_of(ax)
    rate = float(simulation.meta["sample_rate"])
    lost = sum(arrays[name] for name in (*LOSSES, *LEFT_OUT))
    begin = arrays["energy"][0] - (arrays["power_in"][0] - lost[0]) / rate  # as of a plucked string
    given = MJ * (begin + np.cumsum(arrays["power_in"]) / rate)
    rows = {"stored": (MJ * arrays["energy"], STORED)}
    for name, (label, colour) in LOSSES.items():
        rows[label] = (MJ * np.cumsum(arrays[name]) / rate, colour)
    rest = sum(MJ * np.cumsum(arrays[name]) / rate for name in LEFT_OUT)
    rows["contacts that ended"] = (rest, "0.5")
    most = max(float(values.max(initial=0.0)) for values, _ in rows.values())
    rows = {label: row for label, row in rows.items() if row[0].max(initial=0.0) > 1e-3 * most}
    axes.stackplot(
        arrays["time"],
        [values for values, _ in rows.values()],
        labels=list(rows),
        colors=[colour for _, colour in rows.values()],
    )
    axes.plot(arrays["time"], given, "k--", lw=1.0, label="given")
    missing = float(np.abs(arrays["energy_error"]).max(initial=0.0))
    axes.set(xlabel="s", ylabel="mJ", xlim=(0.0, float(arrays["time"][-1])))
    axes.set_title(f"at most {missing:.1e} W missing", loc="left", fontsize="medium")
    axes.legend(loc="upper left", frameon=False, fontsize="small")
    return axes
