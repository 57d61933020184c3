"""The kernel against a plain C version of the same loop: the same steps, and how fast each.

    .venv/bin/python bench/c_comparison.py [--all] [--save bench/results/NAME.json]

Compiles ``bench/c/kernel.c`` on the spot, with leave to reorder sums and to fuse multiply-adds
as numba has it; without a C compiler it says so and ends with exit code 77. Exit code 1 where
single steps differ, or where the kernel takes more than 1.1 times the time. Runs of both
alternate, so that what else the machine does meets both; the verdict is on the fastest of each.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import statistics
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

from c_kernel import FLAGS, OPTIMISED, SAME_LICENCE, TUNED, CKernel, NoCompilerError
from c_steps import (
    START_FRAMES,
    START_TOLERANCE,
    STEP_TOLERANCE,
    by_numba,
    compare_steps,
    controls_for,
    empty_probes,
    start_difference,
)
from rich.console import Console
from rich.table import Table
from run import processor

from yehu_server.physics import kernel
from yehu_server.physics.quantities import Quantities

SLOWEST = 1.1  # times C
SKIPPED = 77  # as test drivers know it
ROUNDS = 25
ROUND_SECONDS = 0.02
FRAMES = 2205  # a call's rows and probes stay in the processor's cache
STATES = 300
RATES = (22050.0, 44100.0, 96000.0)
CASES = {
    "one finger, stopped": (44100.0, 1, {"force": 0.5, "down": 1}),
    "open string": (44100.0, 1, {"force": 0.5}),
    "idle": (44100.0, 1, {}),
    "four fingers down": (44100.0, 4, {"force": 0.5, "down": 4}),
    "96 kHz, stopped": (96000.0, 1, {"force": 0.5, "down": 1}),
}
EXTRA = {
    "plain": OPTIMISED,
    "own width": (*OPTIMISED, *SAME_LICENCE),
    "-ffast-math": (*OPTIMISED, "-ffast-math", *TUNED),
}
NUMBA, C = "numba", "C"


def worst_steps(c: CKernel) -> tuple[dict[str, float], Counter[str]]:
    """How far single steps are off, by field, over all rates, hands and kinds of string."""
    worst: dict[str, float] = {}
    met: Counter[str] = Counter()
    for rate in RATES:
        for fingers in (1, 2, 3, 4):
            for modulation in (1.0, 0.0):
                off, these = compare_steps(c, rate, fingers, modulation, STATES)
                met.update(these)
                for name, value in off.items():
                    worst[name] = max(worst.get(name, 0.0), value)
    return worst, met


def one_call(
    build: CKernel | None, rate: float, fingers: int, options: dict[str, Any]
) -> Callable[[], None]:
    """A call that plays on for `FRAMES` samples, from a steady state."""
    model = kernel.prepare(Quantities(), rate, fingers)
    state = kernel.at_rest(model)
    controls = controls_for(fingers, FRAMES, **options)
    probes = empty_probes(controls, fingers)
    for _ in range(20):
        by_numba(model, state, controls, probes)
    if build is None:
        return lambda: kernel.advance(model, state, controls, probes, None)
    return build.bound(model, state, controls, probes)


def times(builds: dict[str, CKernel | None], case: str) -> dict[str, list[float]]:
    """Nanoseconds a sample of each build, one round after the other in turns."""
    rate, fingers, options = CASES[case]
    calls = {name: one_call(build, rate, fingers, options) for name, build in builds.items()}
    taken: dict[str, list[float]] = {name: [] for name in builds}
    for _ in range(ROUNDS):
        for name, call in calls.items():
            count, start = 0, time.perf_counter()
            while (elapsed := time.perf_counter() - start) < ROUND_SECONDS:
                call()
                count += 1
            taken[name].append(1e9 * elapsed / (count * FRAMES))
    return taken


def ratio(taken: dict[str, list[float]], of: Callable[[list[float]], float], c: str = C) -> float:
    """How many times as long the kernel takes as a build in C."""
    return of(taken[NUMBA]) / of(taken[c])


def show(figures: dict[str, dict[str, list[float]]]) -> None:
    """Print what each build took, and the kernel's time in parts of that."""
    headings = ("ns a sample", "by", "least", "median", "most", "kernel /", "median")
    table = Table(*headings, box=None, padding=(0, 2, 0, 0))
    for case, taken in figures.items():
        for name, values in taken.items():
            sizes = [f"{of(values):.0f}" for of in (min, statistics.median, max)]
            ratios = [f"{ratio(taken, of, name):.3f}" for of in (min, statistics.median)]
            table.add_row(
                case if name == NUMBA else "", name, *sizes, *(ratios if name != NUMBA else [])
            )
    Console().print(table)


def extra_builds(folder: Path) -> dict[str, CKernel]:
    """The other ways to compile it, as far as this machine has them."""
    builds = {}
    for compiler in ("gcc", "clang"):
        ways = dict(EXTRA) if compiler == "gcc" else {"as above": FLAGS} | EXTRA
        for way, flags in ways.items():
            name = f"{compiler}, {way}"
            try:
                builds[name] = CKernel(folder / name.replace(" ", "_"), compiler, flags)
            except NoCompilerError as error:
                print(f"{name}: {str(error).splitlines()[0]}")
                break
            print(f"{name}: {builds[name].version}, {' '.join(flags)}")
    return builds


def main() -> int:
    """Compare, measure, and print everything; the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--all", action="store_true", help="time other compilers and flags too")
    parser.add_argument("--save", type=Path, help="write the figures to a JSON file")
    arguments = parser.parse_args()

    with tempfile.TemporaryDirectory() as scratch:
        try:
            c = CKernel(Path(scratch) / "c")
        except NoCompilerError as error:
            print(f"nothing to compare with: {error}")
            return SKIPPED
        print(f"C: {c.version}, {' '.join(FLAGS)}")
        builds: dict[str, CKernel | None] = {NUMBA: None, C: c}
        if arguments.all:
            builds |= extra_builds(Path(scratch))

        worst, met = worst_steps(c)
        print("\nsingle steps: " + ", ".join(f"{count} {kind}" for kind, count in met.items()))
        for name in sorted(worst, key=lambda name: -worst[name])[:5]:
            print(f"  {name} within {worst[name]:.1g} of its size")
        start = max(start_difference(c, rate) for rate in RATES)
        print(f"the first {START_FRAMES} samples of a stopped note: within {start:.1g}\n")
        figures = {case: times(builds, case) for case in CASES}

    show(figures)
    faults = [f"steps differ in {name}" for name, off in worst.items() if off > STEP_TOLERANCE]
    if start > START_TOLERANCE:
        faults.append("starts differ")
    for case, taken in figures.items():
        if ratio(taken, min) > SLOWEST:
            faults.append(f"{case}: {ratio(taken, min):.3f} times as slow as C")
    print("\n".join(faults) or f"the same steps, and not slower than {SLOWEST} times C")
    if arguments.save:
        record = {
            "machine": f"{processor()}, {os.cpu_count()} cores, {platform.system()}",
            "python": platform.python_version(),
            "compiler": c.version,
            "flags": " ".join(FLAGS),
            "steps": {"count": met["all"], "worst": max(worst.values()), "start": start},
            "figures": {
                f"{case}, {name}": {
                    "unit": "ns a sample",
                    "median": statistics.median(values),
                    "least": min(values),
                    "all": values,
                }
                for case, taken in figures.items()
                for name, values in taken.items()
            },
            "kernel_to_c": {
                case: {"least": ratio(taken, min), "median": ratio(taken, statistics.median)}
                for case, taken in figures.items()
            },
        }
        arguments.save.parent.mkdir(parents=True, exist_ok=True)
        arguments.save.write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
