"""What a page hears of a server, whose clock is not its own."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest

HERE = Path(__file__).parent
MODULE = HERE.parents[2] / "web" / "sound" / "jitter_buffer.js"
AIM = 512  # frames


@pytest.fixture(scope="module")
def heard(node, tmp_path_factory, everything) -> dict[str, Any]:
    folder = tmp_path_factory.mktemp("listened")
    (folder / "package.json").write_text('{"type": "module"}')
    for file in (MODULE, MODULE.with_name("kernel.js")):
        shutil.copy(file, folder)
    seconds = "600" if everything else "30"
    command = [
        node,
        str(HERE / "jitter_buffer.test.mjs"),
        str(folder / "jitter_buffer.js"),
        seconds,
    ]
    done = subprocess.run(command, capture_output=True, text=True, check=True, timeout=120)
    found: dict[str, Any] = json.loads(done.stdout)
    return found


@pytest.mark.parametrize(("clock", "ppm"), [("fast", 200.0), ("slow", -200.0)])
def test_another_clock_is_followed_without_a_gap(heard, clock, ppm) -> None:
    found = heard[clock]
    assert found["gaps"] == 0
    assert found["aim"] == AIM
    assert found["most"] < 2 * AIM
    assert found["frequency"] == pytest.approx(1000.0 * (1.0 + ppm * 1e-6), abs=0.05)


@pytest.mark.parametrize("clock", ["fast", "otherRate", "late"])
def test_left_and_right_are_not_mixed_up(heard, clock) -> None:
    assert heard[clock]["unlike"] < 1e-6


def test_another_rate_sounds_at_the_same_pitch(heard) -> None:
    assert heard["otherRate"]["gaps"] == 0
    assert heard["otherRate"]["frequency"] == pytest.approx(1000.0, abs=0.1)


def test_where_sound_comes_late_more_of_it_waits_until_there_are_few_gaps(heard) -> None:
    assert AIM < heard["late"]["aim"] < 8192
    assert heard["late"]["gaps"] < 10
