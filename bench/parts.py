"""Where the time of a sample goes: by what is played, by instructions, and by part left out.

    .venv/bin/python bench/parts.py

Each part of a step waits for the one before, so the time of a part by itself says little.
The first table is of the whole kernel with ever more to do: nanoseconds (the fastest of many short
runs), and instructions, counted by single steps (Linux on x86-64). The second shows how much faster
the loop becomes when one part is replaced by next to nothing, each in its own process. The model
still sounds there, more or less; a part that others wait for counts with their waiting. The third
is of torsion and wide hair, whose kernel is another: by the fastest of many short runs of it and of
the plain one, in turn.
"""

from __future__ import annotations

import ctypes
import os
import signal
import subprocess
import sys
import time
from typing import Any

import numpy as np
import report

from yehu_server.compile import cache_folder, jit, machine_code
from yehu_server.core.physics import finger, kernel, layout, refined, time_loop
from yehu_server.core.physics.quantities import Quantities, override

FRAMES, RUNS, STEPPED = 4410, 300, 100
SHORT = 441  # frames of kernels in turn, which another program seldom interrupts
SETTLED_S = 0.5
VIBRATO_HZ, VIBRATO_M = 6.0, 1e-3
SPEED, BOW_X, FINGER_X, PRESS = 0.2, 0.26, 0.1, 1.5  # m/s, m, m, N
SINGLE_STEP = 9  # PTRACE_SINGLESTEP

# Number of fingers, of fingers that are down, bow force (N).
CASES = {
    "strings, bridge, radiation": (1, 0, 0.0),
    "and a bow": (1, 0, 0.5),
    "and a finger": (1, 1, 0.5),
    "and three fingers up": (4, 1, 0.5),
    "four fingers down": (4, 4, 0.5),
}
REFINED: dict[str, dict[str, Any]] = {
    "torsion": {"torsion": "on"},
    "hair 8 mm wide, 2 points": {"bow": {"width": 0.008}},
    "and torsion": {"torsion": "on", "bow": {"width": 0.008}},
    "4 points and torsion": {"torsion": "on", "bow": {"width": 0.008, "points": 4}},
}


class Kernel:
    """The kernel after half a second of playing.

    `fingers`, `down`: number of fingers, and of those that are down; others are up, near the loop.
    `force`: of the bow (N).
    `vibrato`: whether the fingers move.
    `changes`: of the instrument.
    """

    def __init__(
        self,
        fingers: int,
        down: int,
        force: float,
        *,
        vibrato: bool = False,
        rate: float = 44100.0,
        is_idle: bool = False,
        changes: dict[str, Any] | None = None,
    ) -> None:
        self.rate, self.playing = rate, (fingers, down, force, vibrato, is_idle)
        quantities = override(Quantities(), changes or {})
        self.model = kernel.prepare(quantities, rate, fingers)
        self.refined = refined.prepare(quantities, rate)
        self.state = kernel.at_rest(self.model)
        self.advance(*self.rows(round(SETTLED_S * rate)))

    def rows(self, frames: int) -> tuple[Any, Any]:
        """Controls, one row a sample, and room for probes."""
        fingers, down, force, vibrato, is_idle = self.playing
        rows = np.zeros((frames, layout.control_columns(fingers)))
        rows[:, [layout.F_N, layout.V_B, layout.X_B]] = force, SPEED * (force > 0.0), BOW_X
        # Keeps the strings that are not bowed in motion, clear of denormals.
        noise = 0.0 if is_idle else 1e-3
        rows[:, layout.F_HAMMER] = noise * np.random.default_rng(1).normal(size=frames)
        swing = np.sin(np.arange(frames) / self.rate * 2.0 * np.pi * VIBRATO_HZ)
        for j in range(fingers):
            at = layout.FINGER_CONTROLS + layout.CONTROLS_PER_FINGER * j
            if j < down:
                rows[:, at] = FINGER_X if down == 1 else 0.03 + 0.03 * j
                rows[:, at] += VIBRATO_M * swing * vibrato
                rows[:, at + 1] = PRESS
            else:
                rows[:, at] = 0.012
        return rows, np.zeros((frames, layout.probe_columns(fingers)))

    def advance(self, rows: Any, probes: Any) -> float:
        """Advance over rows of controls; return the seconds it took."""
        start = time.perf_counter()
        time_loop.run(self.model, self.state, self.refined, rows, probes)
        return time.perf_counter() - start

    def fastest_ns(self) -> tuple[float, float]:
        """Nanoseconds and evaluations of the friction law per sample."""
        rows, probes = self.rows(FRAMES)
        seconds = min(self.advance(rows, probes) for _ in range(RUNS))
        return seconds / FRAMES * 1e9, float(probes[:, layout.ITERATIONS].mean())

    def instructions(self) -> float:
        """Instructions per sample."""
        return (self._stepped(STEPPED) - self._stepped(0)) / STEPPED

    def _stepped(self, frames: int) -> int:
        rows, probes = self.rows(frames)
        libc = ctypes.CDLL(None)
        libc.ptrace.argtypes = [ctypes.c_long, ctypes.c_long, ctypes.c_void_p, ctypes.c_void_p]
        child = os.fork()
        if child == 0:
            libc.ptrace(0, 0, None, None)  # PTRACE_TRACEME
            os.kill(os.getpid(), signal.SIGSTOP)
            self.advance(rows, probes)
            os.kill(os.getpid(), signal.SIGSTOP)
            os._exit(0)
        os.waitpid(child, 0)
        count = 0
        while True:
            libc.ptrace(SINGLE_STEP, child, None, None)
            _, status = os.waitpid(child, 0)
            if not os.WIFSTOPPED(status) or os.WSTOPSIG(status) != signal.SIGTRAP:
                break
            count += 1
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)
        return count


def solve_friction(
    free: Any, _mobility: Any, z: Any, _force: Any, _mu: Any, tangent: Any, _m: Any, _string: Any
) -> Any:
    """Friction: a linear one."""
    v_r = 0.5 * free
    return tangent[0] + 1e-3 * v_r, 0.9 * z + 1e-7 * v_r, v_r, tangent, 1, True


def gradient(_model: Any, eta: Any) -> Any:
    """The contact law's power."""
    return 900.0 * eta


def measure(_m: Any, state: Any, probe: Any) -> None:
    """Probes, radiation, and the watch for a lost state."""
    probe[0] = state.work.f_c[0]


def radiate(_model: Any, _s: Any, bridge_force: Any) -> Any:
    """Radiation alone."""
    return bridge_force


def move_strings(
    _model: Any, _s: Any, _c: Any, w: Any, u_next: Any, _near: Any, _bowed: Any
) -> None:
    """Moving the strings by forces and tension; without it a step begins without a wait."""
    for i in range(layout.STRINGS):
        u_next[i, 5] -= 1e-9 * w.f_c[i]


PARTS = {
    part.__name__: (part, module)
    for part, module in (
        (solve_friction, kernel),
        (move_strings, kernel),
        (measure, kernel),
        (radiate, kernel),
        (gradient, finger),
    )
}


def leave_out(name: str) -> None:
    """Replace a part in this process, before anything is compiled."""
    cache_folder.IS_CACHED = False
    machine_code.address_of = lambda *_: None
    part, module = PARTS[name]
    again: list[tuple[Any, str]] = [
        (kernel, name) for name in ("measure", "solve_contacts", "step", "advance")
    ]
    if module is finger:
        again = [(finger, "advance_fingers"), *again]
    setattr(module, name, jit.compiled(part))
    for where, function in again:
        if function != name:
            setattr(where, function, jit.compiled(getattr(where, function).py_func))
    vars(kernel)["advance_fingers"] = vars(finger)["advance_fingers"]


def in_turn() -> dict[str, dict[str, float]]:
    """Nanoseconds a sample of the kernels of `REFINED`, and those beyond the plain kernel."""
    plain = Kernel(*CASES["and a finger"])
    rows, probes = plain.rows(SHORT)
    found: dict[str, dict[str, float]] = {}
    for name, changes in REFINED.items():
        other = Kernel(*CASES["and a finger"], changes=changes)
        runs = [(plain.advance(rows, probes), other.advance(rows, probes)) for _ in range(RUNS)]
        least, most = np.min(runs, axis=0) / SHORT * 1e9
        found[name] = {
            "ns": float(most),
            "more": float(most - least),
            "evaluations": float(probes[:, layout.ITERATIONS].mean()),
        }
    return found


def main() -> None:
    """Measure and print."""
    if len(sys.argv) == 2:
        leave_out(sys.argv[1])
        print(Kernel(*CASES["and a finger"]).fastest_ns()[0])
        return
    rows = {}
    for name, case in CASES.items():
        machine = Kernel(*case)
        ns, evaluations = machine.fastest_ns()
        instructions = machine.instructions() if sys.platform == "linux" else float("nan")
        rows[name] = {
            "ns": ns,
            "x real time": 1e9 / machine.rate / ns,
            "evaluations": evaluations,
            "instructions": instructions,
        }
    report.show(rows)
    without = {}
    for name, (part, _) in PARTS.items():
        command = [sys.executable, __file__, name]
        run = subprocess.run(command, check=True, capture_output=True, text=True)  # noqa: S603
        faster = rows["and a finger"]["ns"] - float(run.stdout)
        without[name] = {"ns": faster, "is": part.__doc__}
    report.show(without, "With a finger, what it is faster by without")
    report.show(in_turn(), "With a finger, and beyond the plain kernel")


if __name__ == "__main__":
    main()
