"""A plain C++ loop of the bare physics, compiled on the spot: what speeds are given as ratios to.

``yardstick.cpp`` has both strings, one of them bowed, a finger, bridge and radiation in double
precision, by the equations of [Yehu] as corrected in docs/physics.md, without tension modulation.
It gets the same SI values as the kernel, and derives the rest itself.
"""

import os
import shutil
import subprocess
import time
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from kernel_loop import BOW_X, FINGER_X, PRESS, SETTLED_S, SPEED
from numpy.typing import NDArray

from yehu_server.compile import levels
from yehu_server.core.physics.default_quantities import Quantities

SOURCE = Path(__file__).with_name("yardstick.cpp")
# For the level that our own code is compiled for, by GCC's name.
MARCH = {"aarch64": "armv8-a"}.get(levels.level(), levels.level())
FLAGS = ["-O3", f"-march={MARCH}", "-ffast-math", "-std=c++17"]
RATE, FORCE = 44100.0, 0.5  # Hz, N
STRING = ("L", "rho", "r", "T", "E", "sigma_0", "sigma_1")


def values(quantities: Quantities) -> Iterable[float]:
    """The SI values that the yardstick reads after rate and length, in its order."""
    q, bow, finger, body = quantities, quantities.bow, quantities.finger, quantities.body
    yield from (FORCE, SPEED, BOW_X, FINGER_X, PRESS)
    yield from (q.tension_headroom, q.bridge_x)
    for string in q.strings:
        yield from (getattr(string, name) for name in STRING)
    yield from (bow.epsilon_0, bow.epsilon_1, bow.v_s, bow.mu_C, bow.mu_S, bow.xi[0])
    yield from (bow.M_h, bow.K_h, bow.R_h)
    yield from (finger.M_f, finger.K_f, finger.alpha, finger.beta, finger.rest_height)
    for mode in zip(body.frequency_hz, body.mass, body.damping, strict=True):
        yield from mode
    for section in body.sections:
        yield from section
    yield body.direct_gain


@dataclass(frozen=True)
class Run:
    """What one run took: of the loop processor time, of the process time by the clock (s)."""

    cpu_s: float
    clock_s: float
    evaluations: float  # of the friction law, per sample


class Yardstick:
    """The compiled yardstick.

    Raises FileNotFoundError where no C++ compiler is found.
    """

    def __init__(self, folder: Path) -> None:
        names = (os.environ.get("CXX"), "c++", "g++", "clang++")
        compiler = next((path for name in names if name and (path := shutil.which(name))), None)
        if compiler is None:
            raise FileNotFoundError("no C++ compiler is found, so there are no ratios to plain C++")
        self._program, self._folder = folder / "yardstick", folder
        command = [compiler, *FLAGS, str(SOURCE), "-o", str(self._program)]
        subprocess.run(command, check=True)  # noqa: S603
        self._values = " ".join(repr(value) for value in values(Quantities()))

    def run(self, seconds: float, settled: float = SETTLED_S, file: Path | None = None) -> Run:
        """Run it for seconds of sound, in a process of its own; those `settled` do not count."""
        command = [str(self._program), *([] if file is None else [str(file)])]
        start = time.perf_counter()
        done = subprocess.run(  # noqa: S603
            command,
            input=f"{RATE} {settled + seconds} {settled} {self._values}",
            check=True,
            capture_output=True,
            text=True,
        )
        clock_s = time.perf_counter() - start
        cpu_s, evaluations, _ = map(float, done.stdout.split())
        return Run(cpu_s, clock_s, evaluations)

    def sound(self, seconds: float) -> NDArray[np.float64]:
        """The pressure (Pa) from rest on."""
        file = self._folder / "sound"
        self.run(seconds, 0.0, file)
        return np.fromfile(file)
