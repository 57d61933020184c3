"""The rule that names the regime of a bowed string, on motions that are known."""

import csv
from pathlib import Path

import numpy as np
import pytest

from yehu_lab.regimes.columns import REGIMES
from yehu_lab.regimes.judge import judge

HERE = Path(__file__).parent
RATE, NOTE = 44100.0, 441.0
PERIOD = 100  # samples
SPEED = 0.2
LENGTH = 60 * PERIOD
WIDTH = 12  # samples of a slip


def slips(at, depth=-1.6, length=LENGTH):
    """A string that sticks, but for a smooth slip at each of some samples."""
    velocity = np.zeros(length)
    shape = depth * np.sin(np.pi * np.arange(WIDTH) / WIDTH) ** 2
    for begin in at:
        velocity[begin : begin + WIDTH] += shape[: max(0, length - begin)]
    return velocity


def every(distance, begin=0, end=LENGTH - WIDTH):
    return np.arange(begin, end, distance)


def found(velocity, pressure=None, speed=SPEED):
    sound = velocity if pressure is None else pressure
    return judge(velocity, speed, sound, RATE, NOTE)


RNG = np.random.default_rng(7)
LATE = np.cumsum(RNG.uniform(1.2, 3.4, 40) * PERIOD).astype(int)
OFTEN = np.cumsum(RNG.uniform(0.2, 0.9, 200) * PERIOD).astype(int)


def test_a_motion_has_the_regime_that_its_slips_make(subtests):
    for regime, velocity in [
        ("helmholtz", slips(every(PERIOD))),
        ("helmholtz", slips(every(104))),  # 68 cents flat
        ("multiple slip", slips([*every(PERIOD), *every(PERIOD, 37)])),
        ("octave", slips(every(PERIOD // 2))),
        ("octave", slips(every(33))),
        ("anomalous low", slips(every(2 * PERIOD))),
        ("anomalous low", slips(every(130))),
        ("raucous", slips(LATE[LATE < LENGTH - WIDTH])),
        ("aperiodic", slips(OFTEN[OFTEN < LENGTH - WIDTH])),
        ("silent", np.full(LENGTH, -SPEED)),
        ("silent", -SPEED + 0.01 * np.sin(2 * np.pi * np.arange(LENGTH) / PERIOD)),
        ("silent", -3.0 + 0.5 * np.sin(2 * np.pi * np.arange(LENGTH) / PERIOD)),  # never sticks
    ]:
        with subtests.test(regime=regime, velocity=velocity):
            assert found(velocity).regime == regime
            assert judge(-velocity, -SPEED, velocity, RATE, NOTE).regime == regime  # the other way


def test_helmholtz_motion_begins_at_the_first_slip_from_which_they_are_regular():
    begin = 1234
    early = [150, 190, 330, 340 + 3 * WIDTH, 700, 860, 1000]
    finding = found(slips([*early, *every(PERIOD, begin)]))
    assert finding.first_slip_s == pytest.approx(early[0] / RATE, abs=WIDTH / RATE)
    assert finding.helmholtz_s == pytest.approx(begin / RATE, abs=WIDTH / RATE)


def test_level_and_brightness_are_those_of_the_sound():
    time = np.arange(LENGTH) / RATE
    tone = np.sin(2 * np.pi * 2 * NOTE * time)
    finding = found(slips(every(PERIOD)), pressure=0.5 + 0.1 * tone)
    assert finding.level_db == pytest.approx(-20.0 - 10.0 * np.log10(2.0), abs=0.02)
    assert finding.brightness_hz == pytest.approx(2 * NOTE, abs=2.0)
    both = found(slips(every(PERIOD)), pressure=tone + np.sin(2 * np.pi * 10 * NOTE * time))
    assert both.brightness_hz == pytest.approx(6 * NOTE, abs=5.0)
    low = found(slips(every(PERIOD)), pressure=np.sin(2 * np.pi * 130.0 * time))
    assert low.brightness_hz == pytest.approx(130.0, abs=2.0)


def labelled():
    """Strokes that were labelled by hand: label, second reading, and what the rule says."""
    with np.load(HERE / "strokes.npz") as file:
        data = {name: file[name] for name in file.files}
    with (HERE / "labels.csv").open(encoding="utf-8") as text:
        rows = list(csv.DictReader(text))
    ends = np.cumsum(data["lengths"])
    for row, begin, end, scale, speed, frequency in zip(
        rows, ends - data["lengths"], ends, data["scale"], data["bow_velocity"],
        data["frequency_hz"], strict=True,
    ):  # fmt: skip
        velocity = data["relative_velocity"][begin:end] * scale / 127.0
        finding = judge(velocity, speed, velocity, float(data["rate"]), frequency)
        yield row["label"], row["also"], finding.regime


def test_the_rule_agrees_with_labels_by_hand():
    """Odd strokes were held out while it was made. docs/sweep.md has the figures."""
    strokes = list(labelled())
    assert len(strokes) == 300
    assert {label for label, _, _ in strokes} <= set(REGIMES)
    held_out = strokes[1::2]
    same = [label == said for label, _, said in held_out]
    read = [said in (label, also) for label, also, said in held_out]
    assert np.mean(same) >= 0.93
    assert np.mean(read) >= 0.97
