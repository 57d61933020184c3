"""The plug-in's processor time beside that of `render`, for the same MIDI file.

    .venv/bin/python bench/plugin_time.py [--rounds 9] [--block 256] [--save FILE]

Builds the CLAP plug-in for this system, and plays `examples/slow_air.mid` by it in the host of the
tests, round after round in turn with a render on one core. Both are at 48 kHz, in stereo and with
the usual room; times are of the thread that computes. `render` has larger blocks, as usual.
"""

from __future__ import annotations

import subprocess
import tempfile
import time
from argparse import Namespace
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import report

from yehu_server.plugin.build import DPF, build
from yehu_server.rendering.options import Options
from yehu_server.rendering.performance import Performance
from yehu_server.scores.score import Score
from yehu_server.scores.smf.reader import read_score

ROOT = Path(__file__).parents[1]
TUNE = ROOT / "examples" / "slow_air.mid"
RATE = 48000
PLUGIN, RENDER, RATIO = "plug-in", "render", "plug-in over render"


def host_of(folder: Path, block: int, score: Score) -> list[str]:
    """The command that plays a score by the plug-in, both made in a folder."""
    build(folder, "linux")
    program, script = folder / "host", folder / "script"
    source = ROOT / "tests" / "plugin" / "host.c"
    flags = ["-std=gnu11", "-O1", "-DUNCOUNTED", f"-I{DPF}", "-o", str(program)]
    subprocess.run(["cc", *flags, str(source), "-ldl", "-lm"], check=True)  # noqa: S603, S607
    lines = ["0 play 1"]
    for event in score.events:
        data = event.message.bytes()
        padded = (*data, 0, 0)[:3]
        lines.append(" ".join(map(str, (round(event.time_s * RATE), "midi", *padded))))
    script.write_text("\n".join(lines) + "\n")
    numbers = map(str, (RATE, block, round(score.duration_s * RATE)))
    plugin = str(folder / "Yehu.clap")
    return [str(program), plugin, *numbers, str(script), str(folder / "samples")]


def plugin_s(command: Sequence[str]) -> float:
    """Seconds that the plug-in took."""
    done = subprocess.run(command, check=True, capture_output=True, text=True)  # noqa: S603
    told = dict(line.split(" ", 1) for line in done.stdout.splitlines())
    return float(told["took"])


def render_s(score: Score) -> float:
    """Seconds that `render` took."""
    performance = Performance(score, Options(rate=RATE, tail_s=0.0, jobs=1))
    start = time.thread_time()
    for _ in performance.blocks():
        pass
    return time.thread_time() - start


def measure(arguments: Namespace) -> Mapping[str, Mapping[str, Any]]:
    """Time both in turn."""
    score = read_score(TUNE)
    with tempfile.TemporaryDirectory() as name:
        command = host_of(Path(name), arguments.block, score)
        render_s(score)  # compiles
        pairs = [(plugin_s(command), render_s(score)) for _ in range(arguments.rounds)]
    by_plugin, by_render = zip(*pairs, strict=True)
    sound_s = score.duration_s
    return {
        PLUGIN: report.spread([sound_s / each for each in by_plugin], "x real time"),
        RENDER: report.spread([sound_s / each for each in by_render], "x real time"),
        RATIO: report.spread([one / other for one, other in pairs], "times the time"),
    }


if __name__ == "__main__":
    report.run(
        __doc__,
        measure,
        rounds=(9, "runs of each"),
        block=(256, "frames of a block of the plug-in"),
    )
