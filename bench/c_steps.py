"""Single steps from shared states, by the kernel and by its twin in C.

The model is chaotic, so runs of the two drift apart: single steps from the same state can be
compared, to rounding, and so can the first samples of a start.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
from c_kernel import Advance

from yehu_server.physics import kernel, layout
from yehu_server.physics.quantities import Quantities
from yehu_server.physics.string import follow_shape, support

# Of a field's largest value. How a small difference of large numbers is rounded hangs on the
# processor: in 4800 steps, without fused multiply-adds, the worst was off by 3e-12.
STEP_TOLERANCE = 1e-11
START_TOLERANCE = 1e-8
START_FRAMES = 200
# Friction is solved to a residual, not to rounding: with another number of iterations it ends
# elsewhere within that. The tangent, where the next step starts, then is another one; with the
# same number it is a derivative, which takes more from rounding than what it is one of.
WHERE_THE_SOLVER_ENDED = {"iterations", "tangent"}
TANGENT_AMPLIFIES = 1e-3
# What counts after a lost step; the rest is what is left of numbers beyond all bounds.
AT_REST = {
    "level",
    "u",
    "q",
    "zeta",
    "z",
    "U",
    "Psi",
    "v_r",
    "f_b",
    "s_1",
    "s_2",
    "history",
    "lost",
}


def by_numba(model: Any, state: Any, controls: Any, probes: Any) -> None:
    """The kernel of the package, without its ledger."""
    kernel.advance(model, state, controls, probes, None)


def controls_for(
    fingers: int,
    frames: int = 1,
    *,
    force: float = 0.0,
    speed: float = 0.2,
    x_b: float = 0.26,
    down: int = 0,
) -> Any:
    """Rows of a steady bow, so many fingers down and the others lifted."""
    rows = np.zeros((frames, layout.control_columns(fingers)))
    rows[:, [layout.F_N, layout.V_B, layout.X_B]] = force, speed, x_b
    for j in range(fingers):
        at = layout.FINGER_CONTROLS + layout.CONTROLS_PER_FINGER * j
        rows[:, at : at + 2] = 0.1 - 0.02 * j, 1.5 if j < down else 0.0
    return rows


def empty_probes(controls: Any, fingers: int) -> Any:
    """Room for the probes of so many rows of controls."""
    return np.zeros((len(controls), layout.probe_columns(fingers)))


def any_controls(model: Any, rng: np.random.Generator) -> Any:
    """One row of a performance: bow, fingers, now and then a pluck or a knock on the bridge."""
    fingers, h = int(model["fingers"][0]), float(model["h"][0, 0])
    row = controls_for(
        fingers,
        force=float(rng.choice([0.0, 5e-4, 1.0, 1.0, -1.0, -1.0]) * rng.uniform(0.2, 1.5)),
        speed=float(rng.uniform(-0.5, 0.5)),
        x_b=float(rng.choice([0.26, rng.uniform(0.04, 0.31)])),
    )[0]
    row[layout.F_HAMMER] = rng.choice([0.0, 0.0, rng.normal()])
    row[layout.F_PLUCK] = rng.choice([0.0, 0.0, rng.normal()])
    row[layout.X_PLUCK] = rng.uniform(0.03, 0.3)
    for j in range(fingers):
        at = layout.FINGER_CONTROLS + layout.CONTROLS_PER_FINGER * j
        beside = row[layout.X_B] + rng.uniform(-2.0, 2.0) * h
        row[at] = rng.choice([rng.uniform(0.03, 0.3), beside])
        row[at + 1] = rng.choice([0.0, 1.0, 1.0]) * rng.uniform(0.2, 3.0)
    return row[np.newaxis]


def roughen(model: Any, state: Any, controls: Any, rng: np.random.Generator) -> None:
    """Move all that moves by a little, so that a state is one that no performance leads to."""
    m, s = model[0], state[0]
    normal = rng.normal
    now, prev = int(s["level"]), (int(s["level"]) + 2) % layout.LEVELS
    s["u"][:] += 1e-6 * normal(size=s["u"].shape) * m["inside"]
    for points in s["u"].reshape(-1, layout.STRINGS, layout.POINTS):
        for i in range(layout.STRINGS):
            support(points[i], int(m["N"][i]))
    follow_shape(m, s)
    modes = int(m["modes"])
    s["q"][:, :modes] += 1e-8 * normal(size=(layout.LEVELS, modes))
    s["zeta"] += 1e-6 * normal(size=s["zeta"].shape)
    s["z"] = 2e-5 * abs(controls[0, layout.F_N]) * normal(size=layout.STRINGS)
    fingers = int(m["fingers"])
    s["Psi"][: 2 * fingers] = rng.choice([1e-3, 1e-6]) * np.abs(normal(size=2 * fingers))
    # Fingers near the string's line; some leave at up to metres a second.
    s["U"][now, :fingers] = 2e-4 * normal(size=fingers)
    left = rng.choice([2e-7, 2e-5], fingers) * np.abs(normal(size=fingers))
    s["U"][prev, :fingers] = s["U"][now, :fingers] - left


def shared_states(model: Any, count: int, seed: int) -> Iterator[tuple[Any, Any]]:
    """States somewhere in a performance, every other one roughened, and controls for a step."""
    rng = np.random.default_rng(seed)
    fingers = int(model["fingers"][0])
    state = kernel.at_rest(model)
    for n in range(count):
        row = any_controls(model, rng)
        held = np.repeat(row, rng.integers(1, 200), axis=0)
        by_numba(model, state, held, empty_probes(held, fingers))
        shared = state.copy()
        if n % 2:
            row = any_controls(model, rng)
            roughen(model, shared, row, rng)
        if n % 100 == 99:
            shared["zeta"][:] = rng.choice([np.nan, 1e9])  # lost
        yield shared, row


def kinds(before: Any, after: Any, controls: Any, probe: Any) -> Iterator[str]:
    """What kind of step it was: a comparison is worth the kinds that it meets."""
    b, s, row = before[0], after[0], controls[0]
    if probe[0, layout.ITERATIONS] < 0.0:
        yield "lost"
        return
    if probe[0, layout.ITERATIONS] == 0.0:
        yield "bow lifted"
    else:
        yield "first string" if row[layout.F_N] > 0.0 else "second string"
        yield "bristles hold" if s["tangent"][1] == 1.0 else "bristles slip"
    touching = s["g"] > 0.0
    count = int(touching.sum())
    yield ("open", "1 contact", "2 contacts", "3 contacts or more")[min(count, 3)]
    if (touching & (s["g"] < s["ghat"])).any():
        yield "limited by theta"
    if s["dropped_Psi"] > 0.0:
        yield "contact left"
    if s["dropped_z"] > 0.0:
        yield "bow left"
    if row[layout.F_PLUCK] != 0.0:
        yield "plucked"
    if b["slack"].any():
        yield "tension varies"


def floors(model: Any, before: Any, after: Any, controls: Any) -> dict[str, float]:
    """The least size that a quantity counts as having: that of what it is a difference of."""
    m = model[0]

    def size(values: Any) -> float:
        return float(np.abs(np.nan_to_num(values)).max())

    friction = float(m["mu_S"]) * abs(float(controls[0, layout.F_N]))
    stretch = friction / float(m["epsilon_0"])
    newton, pressed = float(m["spread"].max()), size(after["g"] * before["Psi"])
    travel, forces = size(after["q"]), size(after["f_c"])
    return {
        "z": stretch,
        "z_bar": stretch,
        "f_b": friction,
        "v_r": 1.0,  # the solver's tolerance is absolute below 1 m/s
        "r": 1.0,
        "Psi": 1e-6,
        "f_f": max(pressed, 1e-6),
        "d": max(pressed, 1e-6),
        "f_ext": float(m["K_lift"] * m["rest_height"]),
        "shared_with_bridge": newton,
        "at_bow": newton,
        "slack_per_newton": size(after["give"]) * size(after["bend_at"]),
        "f_c_per_newton": 1.0,
        "bridge_travel": travel,
        "history": forces,
        "probe: bridge forces": forces,
        "probe: bridge velocity": 0.5 * float(m["rate"]) * travel,
        "probe: pressure": size(after["s_1"]),
        "probe: friction force": friction,
        "probe: relative velocity": 1.0,
        "probe: finger forces": max(pressed, 1e-6),
    }


def difference(expected: Any, found: Any, floor: float = 0.0) -> float:
    """The largest difference, in parts of the largest value; what is not finite must agree."""
    expected, found = np.asarray(expected), np.asarray(found)
    if expected.dtype.kind != "f":
        return 0.0 if np.array_equal(expected, found) else np.inf
    finite = np.isfinite(expected)
    if not np.array_equal(expected[~finite], found[~finite], equal_nan=True):
        return np.inf
    error = float(np.abs(expected - found, where=finite, out=np.zeros(expected.shape)).max())
    if error == 0.0:
        return 0.0
    return error / max(float(np.abs(expected[finite]).max()), floor)


def probe_groups(fingers: int) -> dict[str, list[int]]:
    """Columns of the probes that are of one kind."""
    first, each = layout.FINGER_PROBES, layout.PROBES_PER_FINGER
    heights = [first + each * j for j in range(fingers)]
    return {
        "probe: bridge forces": [
            layout.BRIDGE_FORCE,
            layout.BRIDGE_FORCE_1,
            layout.BRIDGE_FORCE_2,
        ],
        "probe: bridge velocity": [layout.BRIDGE_VELOCITY],
        "probe: pressure": [layout.PRESSURE],
        "probe: friction force": [layout.FRICTION_FORCE],
        "probe: relative velocity": [layout.RELATIVE_VELOCITY],
        "probe: finger heights": heights,
        "probe: finger forces": [at + 1 + i for at in heights for i in range(layout.STRINGS)],
    }


def step_differences(
    model: Any, before: Any, controls: Any, c: Advance
) -> tuple[dict[str, float], list[str]]:
    """One step by both: how far each field and probe is off, and what kinds of step it was."""
    fingers = int(model["fingers"][0])
    ours, theirs = before.copy(), before.copy()
    our_probe, their_probe = empty_probes(controls, fingers), empty_probes(controls, fingers)
    by_numba(model, ours, controls, our_probe)
    c(model, theirs, controls, their_probe)
    met = [*kinds(before, ours, controls, our_probe), "all"]
    fields = AT_REST if "lost" in met else set(layout.STATE.names or ()) - WHERE_THE_SOLVER_ENDED
    least = floors(model, before, ours, controls)
    off = {field: difference(ours[field], theirs[field], least.get(field, 0.0)) for field in fields}
    for name, columns in probe_groups(fingers).items():
        off[name] = difference(our_probe[:, columns], their_probe[:, columns], least.get(name, 0.0))
    same_end = bool(ours["iterations"][0] == theirs["iterations"][0])
    if same_end:
        off["tangent"] = TANGENT_AMPLIFIES * difference(ours["tangent"], theirs["tangent"], 1.0)
    return off, met if same_end else [*met, "another number of iterations"]


def compare_steps(
    c: Advance, rate: float, fingers: int, modulation: float, count: int, seed: int = 1
) -> tuple[dict[str, float], Counter[str]]:
    """The worst of many single steps, by field; and how many there were of each kind."""
    quantities = replace(Quantities(), tension_modulation=modulation)
    model = kernel.prepare(quantities, rate, fingers)
    worst: dict[str, float] = {}
    met: Counter[str] = Counter()
    for before, controls in shared_states(model, count, seed):
        off, these = step_differences(model, before, controls, c)
        met.update(these)
        for name, value in off.items():
            worst[name] = max(worst.get(name, 0.0), value)
    return worst, met


def start_difference(c: Advance, rate: float) -> float:
    """How far the first samples of a bowed, stopped note are off, in parts of each probe's size."""
    model = kernel.prepare(Quantities(), rate, 1)
    controls = controls_for(1, START_FRAMES, force=0.7, speed=0.3, down=1)
    runs = []
    for advance in (by_numba, c):
        state = kernel.at_rest(model)
        state["U"][:] = -1e-5  # in touch from the first sample
        probes = empty_probes(controls, 1)
        advance(model, state, controls, probes)
        runs.append((probes, state))
    (ours, our_state), (theirs, their_state) = runs
    columns = [n for n in range(ours.shape[1]) if n != layout.ITERATIONS]
    off = [difference(ours[:, n], theirs[:, n]) for n in columns]
    return max(*off, difference(our_state["u"], their_state["u"]))
