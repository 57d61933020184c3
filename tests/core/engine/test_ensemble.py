"""Instruments on one stage: each as if alone, all by one callback."""

import time

import numpy as np
import pytest
from sound import alone, run

from yehu_server.core.controls.record import CHUNK
from yehu_server.core.engine import event_dispatch, mixing, sounding
from yehu_server.core.engine.ensemble import Ensemble
from yehu_server.core.engine.output import SOUNDED
from yehu_server.core.engine.rig import MAX_PARTS
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.core.player.commands import BEGIN
from yehu_server.errors import ParameterError

RATE = 22050.0
KEYS = (69.0, 74.0, 77.0)


def trio(**how: object) -> Ensemble:
    """Three who play a note each, in three places."""
    ensemble = Ensemble([InstrumentSpec(RATE, seed=k, body=k) for k in range(3)], **how)
    for instrument, key, pan in zip(ensemble.instruments, KEYS, (-0.5, 0.0, 0.7), strict=True):
        instrument.post(BEGIN, value=key, other=key)
        instrument.write("/room/pan", pan)
        instrument.write("/output/gain", -12.0, ramp_ms=0.0)
    return ensemble


def both(ensemble: Ensemble, frames: int, block: int = 0) -> np.ndarray:
    out = np.zeros((frames, 2), np.float32)
    for start in range(0, frames, block or frames):
        ensemble.process(out[start : start + (block or frames)])
    return out


def apart(ensemble: Ensemble, frames: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """What `process` would give, by computing each instrument apart: mix, stems, dry samples."""
    parts = len(ensemble.instruments)
    sounded = np.zeros((parts, -(-frames // CHUNK)), SOUNDED)
    first = ensemble.frame
    assert event_dispatch.interpret_events.call(ensemble.address, first + frames) == first + frames
    for instrument, own in zip(ensemble.instruments, sounded, strict=True):
        sounding.sound_block.call(instrument.address, frames, own.ctypes.data)
    out = np.zeros((frames, ensemble.channels), np.float32)
    stems = np.zeros((frames, parts + 1, 2))
    into = (out.ctypes.data, stems.ctypes.data, 1)
    mixing.mix_block.call(ensemble.address, sounded.ctypes.data, first, frames, *into)
    return out, stems, sounded["dry"].reshape(parts, -1)[:, :frames]


def test_instruments_sound_the_same_apart_as_in_the_callback():
    frames = 4000
    out, _, _ = apart(trio(), frames)
    assert np.abs(out).max() > 0.02
    np.testing.assert_array_equal(out, both(trio(), frames, block=333))


def test_an_instrument_sounds_among_others_as_it_does_alone():
    _, _, dry = apart(trio(), 4000)
    for k, key in enumerate(KEYS):
        one = alone(RATE, seed=k)
        one.first.post(BEGIN, value=key, other=key)
        one.first.write("/output/gain", -12.0, ramp_ms=0.0)
        np.testing.assert_array_equal(run(one, 4000), dry[k].astype(np.float32))


@pytest.mark.parametrize("gain_db", [-12.0, 24.0], ids=["as it is", "limited"])
def test_the_mix_is_the_sum_of_its_stems(gain_db):
    ensemble = trio()
    ensemble.instruments[1].write("/output/gain", gain_db)
    out, stems, _ = apart(ensemble, 6000)
    peak = np.abs(out).max()
    assert 0.05 < peak <= 1.0
    assert (peak > 0.71) == (gain_db > 0.0)  # the limiter acts from -3 dB on
    np.testing.assert_allclose(stems.sum(axis=1), out, atol=1e-6)
    assert np.abs(stems[:, -1]).max() > 0.001  # the room


def test_after_a_process_died_all_go_on_at_one_frame_and_nothing_sounds():
    ensemble = trio()
    both(ensemble, 4096)
    first, second, _ = ensemble.instruments
    first._rig["meters"]["running"] = 1
    first._rig["controls"]["frame"] += 64  # the others were not yet computed
    second._rig["state"]["motion"]["u"] = np.nan
    ensemble.recover()
    assert [instrument.frame for instrument in ensemble.instruments] == [4160] * 3
    assert ensemble.gaps == [(4096, 4160)]
    begin, samples = ensemble.taped(4000)
    assert (begin, len(samples)) == (4000, 160)
    assert samples[:96].any()
    assert not samples[96:].any()
    assert not both(ensemble, 2000).any()
    assert ensemble.lost_states == 0


def test_all_take_the_time_from_one_clock():
    ensemble = trio()
    both(ensemble, 4000, block=333)
    now_ns = time.monotonic_ns()
    frames = [instrument.frame_at(now_ns) for instrument in ensemble.instruments]
    assert frames == [ensemble.frame_at(now_ns)] * 3
    assert frames[0] > 0.0


def test_one_channel_has_the_mean_of_both_and_further_ones_have_left_and_right_in_turn():
    one, many, both_sides = np.zeros(1000, np.float32), np.zeros((1000, 5), np.float32), trio()
    trio(channels=1).process(one)
    trio(channels=5).process(many)
    expected = both(both_sides, 1000)
    np.testing.assert_allclose(one, expected.mean(axis=1), atol=1e-7)
    np.testing.assert_array_equal(many, expected[:, [0, 1, 0, 1, 0]])
    np.testing.assert_array_equal(both_sides.taped(0)[1], expected)
    assert np.abs(expected[:, 0] - expected[:, 1]).max() > 0.001


def test_a_stage_has_room_for_1_to_16_of_one_rate_that_it_plays_itself():
    for parts in (0, MAX_PARTS + 1):
        with pytest.raises(ParameterError, match=f"{parts} parts: a stage has 1 to 16"):
            Ensemble([InstrumentSpec(RATE)] * parts)
    with pytest.raises(ParameterError, match="one sample rate"):
        Ensemble([InstrumentSpec(22050.0), InstrumentSpec(44100.0)])
    with pytest.raises(TypeError, match="played by the ensemble"):
        alone(RATE).first.process(np.zeros(64, np.float32))
