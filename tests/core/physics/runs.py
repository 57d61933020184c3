"""Run the kernel for a test, and measure its output; expectations are in the tests."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from yehu_server.core.physics import kernel, layout, planes, time_loop
from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.core.physics.string import set_Delta_u

COLUMNS = {
    "F_N": layout.F_N,
    "v_b": layout.V_B,
    "x_b": layout.X_B,
    "y_b": layout.Y_B,
    "texture": layout.TEXTURE,
    "hammer": layout.F_HAMMER,
    "pluck": layout.F_PLUCK,
    "x_pluck": layout.X_PLUCK,
}
PROBES = {
    "bridge_force": layout.BRIDGE_FORCE,
    "bridge_velocity": layout.BRIDGE_VELOCITY,
    "pressure": layout.PRESSURE,
    "f_b": layout.FRICTION_FORCE,
    "v_r": layout.RELATIVE_VELOCITY,
    "iterations": layout.ITERATIONS,
}
# Ways in and out of power, without the energy dropped within one sample.
FLOWS = ("power_in", *(f"loss_{by}" for by in ("strings", "bridge", "finger", "hair", "friction")))

Curves = Mapping[str, Any]  # F_N, v_b, x_b, hammer; x_f and press: one entry a finger


@dataclass(frozen=True)
class Run:
    """One run of the kernel: signals by name, and the state at its end."""

    rate: float
    model: Any
    state: Any
    refined: Any
    controls: Any
    probes: Any
    ledger: Any

    def __getitem__(self, name: str) -> Any:
        """A probe or a ledger column, one value a sample."""
        if name in PROBES:
            return self.probes[:, PROBES[name]]
        return self.ledger[:, layout.LEDGER.index(name)]

    def finger(self, j: int) -> Any:
        """Height of a finger and its two contact forces [shape=(frames, 3)]."""
        at = layout.FINGER_PROBES + layout.PROBES_PER_FINGER * j
        return self.probes[:, at : at + layout.PROBES_PER_FINGER]

    @property
    def power(self) -> float:
        """The largest power that flowed in or out (W)."""
        return max(float(np.abs(self[name]).max()) for name in FLOWS)


def rows(frames: int, fingers: int, curves: Curves) -> Any:
    """Control rows from curves; what is not given is zero, bow and fingers in the middle."""
    table = np.zeros((frames, layout.control_columns(fingers)))
    table[:, layout.X_B] = 0.255
    for name, column in COLUMNS.items():
        if name in curves:
            table[:, column] = curves[name]
    for j in range(fingers):
        at = layout.FINGER_CONTROLS + layout.CONTROLS_PER_FINGER * j
        table[:, at] = curves.get("x_f", (0.1,) * fingers)[j]
        table[:, at + 1] = curves.get("press", (0.0,) * fingers)[j]
    return table


def play(
    curves: Callable[[Any], Curves] | Curves,
    seconds: float,
    rate: float = 44100.0,
    *,
    fingers: int = 1,
    quantities: Quantities | None = None,
    state: Any = None,
    ledger: bool = True,
) -> Run:
    """Run the kernel over curves, given as functions of time (s) or as constants."""
    quantities = quantities or Quantities()
    model = kernel.prepare(quantities, rate, fingers)
    more = planes.prepare(quantities, rate)
    state = kernel.at_rest(model) if state is None else state
    frames = round(seconds * rate)
    if callable(curves):
        curves = curves(np.arange(frames) / rate)
    controls = rows(frames, fingers, curves)
    probes = np.zeros((frames, layout.probe_columns(fingers)))
    book = np.zeros((frames if ledger else 0, len(layout.LEDGER)))
    time_loop.run(model, state, more, controls, probes, book if ledger else None)
    return Run(rate, model, state, more, controls, probes, book)


def shaped(model: Any, string: int, shape: Callable[[Any], Any]) -> Any:
    """A state at rest but for one string, displaced to shape(x) (m) and about to be let go."""
    state = kernel.at_rest(model)
    N, h = int(model["N"][0, string]), float(model["h"][0, string])
    u = state["motion"]["u"][0, :, string, :]
    u[:, layout.GHOST : layout.GHOST + N + 1] = shape(np.arange(N + 1) * h)
    u[:, layout.GHOST] = u[:, layout.GHOST + N] = 0.0
    u[:, 0], u[:, N + 2] = -u[:, 2], -u[:, N]
    set_Delta_u(model[0], state[0]["motion"])
    return state


def bump(left: float, right: float, height: float) -> Callable[[Any], Any]:
    """A smooth pluck: sin^4 between two places, flat outside."""

    def shape(x: Any) -> Any:
        inside = np.clip((x - left) / (right - left), 0.0, 1.0)
        return height * np.sin(np.pi * inside) ** 4

    return shape


def frequency_near(signal: Any, rate: float, guess: float) -> float:
    """Frequency (Hz) of the partial next to `guess`, from the phase of two Hann windows.

    They lie ever further apart, so that the phase between them is never off by a turn.
    """
    size = 2 * len(signal) // 3
    window = np.hanning(size)
    time = np.arange(len(signal)) / rate
    for gap in (len(signal) // 24, len(signal) // 6, len(signal) - size, len(signal) - size):
        turned = signal * np.exp(-2j * np.pi * guess * time)
        early, late = window @ turned[:size], window @ turned[gap : gap + size]
        guess += float(np.angle(late / early)) / (2.0 * np.pi * gap / rate)
    return guess
