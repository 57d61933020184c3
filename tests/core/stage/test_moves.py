"""What moves while it sounds makes no click, and is the same in blocks of any size."""

import numpy as np
import pytest
import scipy
from stages import NAMES, RANGES, SILENCED, SMALL, Stage, stage_inputs

RATE = 48000.0
RAMP = np.clip(np.linspace(-5.0, 6.0, round(1.1 * RATE)), 0.0, 1.0)  # 0.5 s, 0.1 s, 0.5 s
MOVES = {
    "pan": (-0.8, 0.8),
    "distance": (1.5, 6.0),
    "size": (4.0, 30.0),
    "decay": (0.3, 2.0),
    "damping": (0.1, 0.9),
    "level": (0.0, 1.0),
    "width": (0.0, 1.0),
}


def tone(frames: int) -> np.ndarray:
    """A note of 400 Hz with eight partials, all below 4 kHz."""
    at = np.arange(frames) / RATE
    return 0.01 * sum(np.sin(2.0 * np.pi * 400.0 * k * at) / k for k in range(1, 9))


def splash(out: np.ndarray) -> np.ndarray:
    """Energy above 10 kHz, where the note has nothing, in windows of 5 ms."""
    sections = scipy.signal.butter(8, 10000.0, "highpass", fs=RATE, output="sos")
    high = scipy.signal.sosfilt(sections, out, axis=0)
    window = round(0.005 * RATE)
    count = len(high) // window
    return np.sum(np.square(high[: count * window]).reshape(count, -1), axis=1)


@pytest.mark.parametrize("name", MOVES)
def test_a_move_while_a_note_sounds_makes_no_click(name):
    frames = len(RAMP)
    here, there = MOVES[name]
    way = here + (there - here) * RAMP
    if name == "size":  # which is not smoothed before it comes here
        way = np.where(RAMP < 0.5, here, there)
    stage = Stage(RATE)
    asked = {"level": 0.5, name: here}
    lead = round(0.5 * RATE)
    stage.play(tone(frames + lead)[:lead], stage_inputs(lead, **asked))
    stems = stage.play(tone(frames + lead)[lead:], stage_inputs(frames, **asked | {name: way}))[1]
    out = stems.sum(axis=1)
    note = np.sum(np.square(out)) / len(out) * round(0.005 * RATE)
    # A click that is 60 dB below the note, in 5 ms of it, is not heard under it.
    assert splash(out)[20:].max() < 1e-6 * note


def moving(rng: np.random.Generator, parts: int, frames: int) -> tuple[np.ndarray, np.ndarray]:
    """Sounds, and places that jump about all ranges; sometimes one falls silent."""
    dry = 0.05 * rng.normal(size=(parts, frames))
    rows = np.zeros((parts, frames, SILENCED + 1))
    for part in range(parts):
        jumps = {name: rng.uniform(*RANGES[name], 1 + frames // 997) for name in NAMES}
        values = {name: np.repeat(each, 997)[:frames] for name, each in jumps.items()}
        values["level"][rng.integers(frames) :][:500] = 0.0
        rows[part] = stage_inputs(frames, **values)
        rows[part, rng.integers(frames), SILENCED] = 1.0
    return dry, rows


@pytest.mark.parametrize("parts", [1, 3])
def test_blocks_of_any_size_give_the_same_bits(parts):
    frames = 36000
    for seed in range(2):
        rng = np.random.default_rng(seed)
        dry, rows = moving(rng, parts, frames)
        whole, stems = Stage(RATE, parts).play(dry, rows)
        stage = Stage(RATE, parts)
        done = 0
        while done < frames:
            count = int(min(frames - done, rng.choice([1, 7, 31, 32, 33, 64, 100, 128, 1000])))
            some = slice(done, done + count)
            out, own = stage.play(dry[:, some], rows[:, some])
            assert np.array_equal(out, whole[some])
            assert np.array_equal(own, stems[some])
            done += count
        assert np.abs(stems[:, -1]).max() > 0.0


@pytest.mark.parametrize("rate", [22050.0, 44100.0, 96000.0, 192000.0])
def test_the_mix_is_finite_at_all_extremes(rate):
    rng = np.random.default_rng(7)
    stage = Stage(rate, 2)
    frames = 3000
    for corner in range(24):
        asked = {name: RANGES[name][rng.integers(2)] for name in NAMES}
        dry = rng.choice([0.0, 1.0, 900.0]) * rng.normal(size=(2, frames))
        out, stems = stage.play(dry, stage_inputs(frames, **asked))
        assert np.isfinite(out).all(), corner
        assert np.isfinite(stems).all(), corner
        assert np.abs(out).max() <= 1.0
    assert stage.record["invalid_samples"] == 0


@pytest.mark.parametrize("asked", [{"size": 2.0, "decay": 10.0}, {"size": 40.0, "decay": 10.0}])
def test_a_room_whose_size_swings_does_not_grow_louder(asked):
    stage = Stage(RATE)
    stage.settle(**asked, level=1.0, damping=0.0)
    frames = round(0.1 * RATE)
    dry = SMALL * np.random.default_rng(1).normal(size=frames)
    stage.play(dry, stage_inputs(frames, **asked, level=1.0, damping=0.0))
    peaks = []
    for k in range(40):
        rows = stage_inputs(frames, **asked | {"size": (2.0, 40.0)[k % 2]}, level=1.0, damping=0.0)
        peaks.append(np.abs(stage.play(np.zeros(frames), rows)[1]).max())
    assert max(peaks[10:]) < 10.0 * max(peaks[:10])
    assert max(peaks) < 1.0


@pytest.mark.parametrize("size", [20.0, 40.0])
def test_a_panic_empties_the_room(size):
    stage = Stage(RATE)
    asked = {"level": 1.0, "decay": 5.0, "size": size, "distance": 1.0}
    stage.settle(**asked)
    frames = round(0.5 * RATE)
    rows = stage_inputs(frames, **asked)
    dry = tone(frames)
    dry[frames // 2 :] = 0.0
    rows[frames // 2, SILENCED] = 1.0
    out = stage.play(dry, rows)[1][:, 1]
    assert np.abs(out[frames // 2 - 100 : frames // 2]).max() > 1e-3
    after = out[frames // 2 :]
    assert not after[round(0.006 * RATE) :].any()
    quiet = stage.play(np.zeros(frames), stage_inputs(frames, **asked))[1]
    assert not quiet.any()
    again = stage.play(tone(frames), stage_inputs(frames, **asked))[1][:, 1]
    assert np.abs(again[frames // 2 :]).max() > 1e-3  # and it opens again


def test_a_room_that_was_turned_off_is_empty_when_it_is_heard_again():
    stage = Stage(RATE)
    asked = {"level": 1.0, "decay": 5.0}
    stage.settle(**asked)
    frames = round(0.3 * RATE)
    stage.play(tone(frames), stage_inputs(frames, **asked))
    stage.play(np.zeros(frames), stage_inputs(frames, **asked | {"level": 0.0}))
    assert not stage.play(np.zeros(frames), stage_inputs(frames, **asked))[1].any()
