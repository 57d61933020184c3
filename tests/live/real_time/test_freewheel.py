"""The live path through a freewheeling audio server gives the same samples as offline."""

import mido
import numpy as np
import pytest
from waiting import LONG_S, until

from yehu_server.core.engine.ensemble import Ensemble
from yehu_server.core.engine.instrument import Instrument
from yehu_server.live.audio.output import Output, OutputOptions
from yehu_server.playing.calibration_store import calibration_for
from yehu_server.playing.mapping import load
from yehu_server.playing.options import PlayingOptions

RATE = 48000
FIRST = 12 * RATE  # by then the device has taken over
FRAMES = 4 * RATE
BLOCKS = [64, *(pytest.param(block, marks=pytest.mark.slow) for block in (100, 128, 333, 1024))]
STYLE = PlayingOptions(mapping=load("keyboard"), seed=3)


def stage_of(memory: object = None) -> Ensemble:
    calibration = calibration_for(float(RATE))
    return Ensemble([STYLE.spec(float(RATE), calibration)], memory=memory)


def play(instrument: Instrument) -> None:
    """Schedule notes and controllers from frame FIRST on."""
    midi = STYLE.mapped(STYLE.player(instrument))
    score = [
        (0, mido.Message("note_on", note=67, velocity=90)),
        (9001, mido.Message("control_change", control=1, value=110)),
        (12_345, mido.Message("pitchwheel", pitch=3000)),
        (15_000, mido.Message("aftertouch", value=100)),
        (20_011, mido.Message("note_on", note=72, velocity=40)),
        (20_017, mido.Message("note_off", note=67)),
        (50_000, mido.Message("note_off", note=72)),
        (60_003, mido.Message("note_on", note=65, velocity=127)),
        (80_000, mido.Message("control_change", control=120)),
        (90_000, mido.Message("note_on", note=84, velocity=100)),
        *(
            (90_000 + 37 * step, mido.Message("pitchwheel", pitch=int(4000 * np.sin(0.02 * step))))
            for step in range(1000)
        ),
        (160_000, mido.Message("note_off", note=84)),
    ]
    for frame, message in score:
        midi.receive(message, frame=FIRST + frame)


@pytest.fixture(scope="module")
def offline() -> np.ndarray:
    stage = stage_of()
    play(stage.first)
    out = np.zeros((FIRST + FRAMES, 2), np.float32)
    for start in range(0, len(out), 4096):
        stage.process(out[start : start + 4096])
    assert not out[:FIRST].any()
    assert np.abs(out[FIRST:]).max() > 0.05
    return out[FIRST:]


def first_sound(samples: np.ndarray) -> int:
    return int(np.flatnonzero(samples)[0])


@pytest.mark.parametrize("block", BLOCKS)
def test_live_and_offline_give_the_same_samples(offline, block, jackd, recorder):
    jackd.start(128)
    output = Output(OutputOptions(device="system, JACK", blocksize=block), lambda _line: None)
    try:
        assert output.find() == RATE
        stage = stage_of(output.memory.buffer)
        instrument = stage.first
        play(instrument)
        output.begin(stage)
        listener = recorder().connected()
        assert instrument.frame < FIRST
        assert output.state.device == "system, JACK Audio Connection Kit"
        before = instrument.meters()["callbacks"]
        listener.forget()
        listener.freewheel(on=True)
        until(lambda: instrument.frame >= FIRST + FRAMES, "all frames", LONG_S)
        listener.freewheel(on=False)
        begin, tape = stage.taped(FIRST)
        meters = instrument.meters()
        heard = listener.recording().samples
    finally:
        output.end()
    assert begin == FIRST
    np.testing.assert_array_equal(tape[:FRAMES], offline)
    assert meters["late_events"] == 0
    assert meters["callbacks"] - before >= FRAMES // block
    at = first_sound(heard[0]) - first_sound(offline[:, 0])
    np.testing.assert_array_equal(heard[:, at : at + FRAMES].T, offline)
