"""A recording that begins with the first sound."""

import time

import numpy as np
import pytest
import soundfile

from yehu_server.live.audio.recordings import BEFORE_S, Recorder

RATE = 48_000


class Tape:
    """Sound that is there as far as it was played."""

    rate = float(RATE)

    def __init__(self, sound: np.ndarray) -> None:
        self.sound = sound
        self.frame = 0

    def taped(self, begin: int) -> tuple[int, np.ndarray]:
        return begin, self.sound[begin : self.frame]


def play(tape: Tape, *frames: int) -> None:
    for frame in frames:
        tape.frame = frame
        time.sleep(0.12)


@pytest.fixture
def said() -> list[str]:
    return []


@pytest.mark.parametrize("begins", [10, 20_000, 24_000, 24_001])
def test_it_begins_a_moment_before_and_records_later_pauses(tmp_path, said, begins) -> None:
    sound = np.zeros((48_000, 2), np.float32)
    sound[begins:, 1] = 0.25
    sound[begins + 1000 : 40_000] = 0.0  # a pause
    tape, target = Tape(sound), tmp_path / "take.wav"
    recorder = Recorder(tape, target, 0, said.append, waits=True)
    play(tape, 12_000, 24_000, 36_000, 48_000)
    recorder.stop()
    assert recorder.is_whole
    found, _ = soundfile.read(target)
    first = max(begins - round(BEFORE_S * RATE), 0)
    assert len(found) == 48_000 - first
    assert np.abs(found[: begins - first]).max(initial=0.0) == 0.0
    assert found[begins - first, 1] == pytest.approx(0.25, abs=1e-3)
