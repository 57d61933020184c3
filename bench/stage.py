"""What the stage costs: nanoseconds a frame of the room, of each seat, and of 1 to 16 parts.

    .venv/bin/python bench/stage.py [--save bench/results/NAME.json]

Noise stands for the instruments, which are not computed. Figures are the least of many runs, at
48 kHz. The room is the difference to a level of 0, a seat half that of three parts to one.
"""

from __future__ import annotations

import argparse
import sys
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import report

from yehu_server.core.engine.mixing import mix_block

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests"))
stages: Any = import_module("stages")

RATE, FRAMES, RUNS = 48000.0, 4800, 60
PARTS = (1, 2, 3, 4, 8, 16)


def fastest_ns(parts: int, *, has_room: bool = True, **asked: Any) -> float:
    """Nanoseconds a frame of the whole mix."""
    stage = stages.Stage(RATE, parts, has_room=has_room)
    dry = 0.01 * np.random.default_rng(1).normal(size=(parts, FRAMES))
    inputs = stages.stage_inputs(FRAMES, **asked)
    sounded = stages.as_sounded(dry, np.broadcast_to(inputs, (parts, *inputs.shape)))
    out = np.zeros((FRAMES, 2), np.float32)

    def mix() -> None:
        mix_block.call(
            stage.memory.ctypes.data, sounded.ctypes.data, stage.frame, FRAMES,
            out.ctypes.data, out.ctypes.data, 0,
        )  # fmt: skip
        stage.frame += FRAMES

    return 1e9 * min(report.timed(mix, RUNS)) / FRAMES


def measure(_: argparse.Namespace) -> dict[str, dict[str, float]]:
    whole = {parts: fastest_ns(parts) for parts in PARTS}
    figures = {
        "room": whole[1] - fastest_ns(1, level=0.0),
        "seat": (whole[3] - whole[1]) / 2.0,
        "dry, one part": fastest_ns(1, has_room=False),
        "hall, one part": fastest_ns(1, size=25.0, decay=1.6, level=0.7),
        **{f"{parts} parts": figure for parts, figure in whole.items()},
    }
    return {name: {"ns a frame": figure} for name, figure in figures.items()}


if __name__ == "__main__":
    report.run(__doc__, measure)
