"""An instrument at rest is not computed, and nobody hears that it was not."""

from collections.abc import Callable

import numpy as np
import pytest
from sound import alone, run

from yehu_server.core.engine.ensemble import Ensemble
from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.sleep import QUIET, WINDOW
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.core.player.commands import BEGIN, END, HOLD, WRITE
from yehu_server.core.player.parameter_indices import INDEX, PLAYING
from yehu_server.core.stage.seat import HISTORY_FRAMES

RATE = 44100.0
FROM = 5000  # frame of the first event, by which all sleep


def is_asleep(instrument: Instrument) -> bool:
    return bool(instrument._rig["output"]["sleep"]["is_asleep"][0])


def slept(instrument: Instrument) -> int:
    return int(instrument.meters()["slept"])


def damp(instrument: Instrument) -> None:
    """Let strings die away within a second."""
    for string in ("inner", "outer"):
        instrument.write(f"/string/{string}/loss", 4.0, ramp_ms=0.0)


def pluck(instrument: Instrument, frame: int) -> None:
    instrument.write("/pluck/force", 1.0, frame=frame, ramp_ms=2.0)


def play(instrument: Instrument, frame: int, frames: int = 3000, key: float = 69.0) -> None:
    instrument.post(BEGIN, frame=frame, value=key, other=key)
    instrument.post(END, frame=frame + frames, value=key)


def until_asleep(ensemble: Ensemble, most_s: float = 30.0) -> np.ndarray:
    """What is heard until it falls asleep."""
    pieces = [run(ensemble, WINDOW + 1 - ensemble.frame % WINDOW)]
    while not is_asleep(ensemble.first):
        assert ensemble.frame < most_s * ensemble.rate
        pieces.append(run(ensemble, WINDOW))
    return np.concatenate(pieces)


def two_notes(parts: int = 1) -> Ensemble:
    """Each part plays two notes, between which it falls asleep, as it does after them."""
    ensemble = Ensemble([InstrumentSpec(RATE, seed=k, body=k) for k in range(parts)])
    ensemble.first.write("/room/decay", 0.1, ramp_ms=0.0)
    for k, instrument in enumerate(ensemble.instruments):
        damp(instrument)
        play(instrument, FROM + 1000 * k, key=66.0 + k % 12)
        play(instrument, 90_001 + 777 * k, key=74.0)
    return ensemble


def blocks(ensemble: Ensemble, block: int, pieces: int, piece: int) -> tuple[np.ndarray, list]:
    """What is heard, and how much each part had slept after each piece."""
    heard, counts = [], []
    for _ in range(pieces):
        out = np.zeros((piece, 2), np.float32)
        for start in range(0, piece, block):
            ensemble.process(out[start : start + block])
        heard.append(out)
        counts.append([slept(instrument) for instrument in ensemble.instruments])
    return np.concatenate(heard), counts


# ---------------------------------------------------------------- when


def test_an_instrument_that_nobody_plays_sleeps_from_the_second_window_on():
    ensemble = alone(RATE)
    run(ensemble, WINDOW)
    assert slept(ensemble.first) == 0
    run(ensemble, 1000)
    assert slept(ensemble.first) == 1000


@pytest.mark.parametrize("block", [1, 7, 64, 1000])
def test_it_falls_asleep_and_wakes_at_the_same_frames_in_blocks_of_any_size(block):
    expected, counts = blocks(two_notes(), 1024, 20, 7 * 1024)
    heard, own = blocks(two_notes(), block, 20, 7 * 1024)
    assert own == counts
    np.testing.assert_array_equal(heard, expected)
    growing = (
        np.diff([0, *(count for (count,) in counts)]) > 0
    )  # slept, played, slept, played, slept
    assert np.count_nonzero(np.diff(growing)) == 4


# ---------------------------------------------------------------- what is heard


@pytest.mark.parametrize("frame", [2 * WINDOW, 2 * WINDOW + 1, 9999, 3 * WINDOW - 1])
def test_what_comes_in_sleep_sounds_as_it_does_at_rest_from_that_frame_on(frame):
    at_rest, asleep = alone(RATE), alone(RATE)
    for ensemble, at in ((at_rest, 100), (asleep, frame)):
        pluck(ensemble.first, at)
        assert not run(ensemble, at).any()
    assert is_asleep(asleep.first)
    assert not is_asleep(at_rest.first)
    expected, heard = run(at_rest, 3000), run(asleep, 3000)
    assert np.abs(expected).max() > 1e-3
    np.testing.assert_array_equal(heard, expected)


@pytest.mark.parametrize("speed", [0.0, 6.0])
def test_a_note_is_the_same_after_a_silence_that_was_slept_through_and_one_that_was_not(speed):
    """Phases of vibrato and tremolo went on, and as many numbers were drawn by chance."""
    heard = []
    for keeps_awake in (False, True):
        ensemble = alone(RATE, seed=7)
        one = ensemble.first
        one.post(HOLD, index=INDEX["/playing/vibrato"], value=1.0)
        one.post(HOLD, index=INDEX["/playing/variation"], value=1.0)
        one.write("/vibrato/depth", 20.0, ramp_ms=0.0)
        one.write("/bow/tremolo", speed, ramp_ms=0.0)
        for frame in range(0, 3 * WINDOW, 50) if keeps_awake else ():
            one.write("/bow/position", 0.13, frame=frame, ramp_ms=0.0)
        play(one, 3 * WINDOW + 5, frames=20_000)
        heard.append(run(ensemble, 12 * WINDOW))
        assert (slept(one) > WINDOW) == (not keeps_awake)
    assert np.abs(heard[0]).max() > 1e-3
    np.testing.assert_array_equal(heard[0], heard[1])


def test_it_wakes_as_if_it_had_been_computed_all_the_time():
    heard = []
    for speed in (0.0, 0.1):  # a bow that moves in the air keeps it awake
        ensemble = Ensemble([InstrumentSpec(RATE)])
        one = ensemble.first
        damp(one)
        one.write("/bow/speed", speed, ramp_ms=0.0)
        pluck(one, FROM)
        pluck(one, 5 * HISTORY_FRAMES)
        out, counts = blocks(ensemble, 1024, 6, HISTORY_FRAMES)
        heard.append(out)
        assert (counts[-1][0] > HISTORY_FRAMES) == (speed == 0.0)
        assert (counts[-1][0] == 0) == (speed != 0.0)
    assert np.abs(heard[0][FROM:]).max() > 1e-3
    np.testing.assert_allclose(heard[0], heard[1], rtol=1e-6, atol=1e-9)


def test_a_parameter_that_is_set_in_sleep_holds_afterwards():
    heard = []
    for frame in (0, 10_000):
        ensemble = Ensemble([InstrumentSpec(RATE)])
        ensemble.first.write("/output/gain", -12.0, frame=frame)
        ensemble.first.write("/room/size", 12.0, frame=frame)
        ensemble.first.write("/room/pan", 0.5, frame=frame)
        ensemble.first.write("/string/inner/tuning", 30.0, frame=frame)
        pluck(ensemble.first, 30_000)
        out = np.zeros((60_000, 2), np.float32)
        ensemble.process(out)
        assert slept(ensemble.first) > 10_000
        heard.append(out)
    np.testing.assert_allclose(heard[1], heard[0], atol=1e-6)
    assert np.abs(heard[0]).max() > 1e-3


def test_a_finger_that_rests_on_a_string_lets_it_sleep_and_makes_no_sound_as_it_wakes():
    ensemble = alone(RATE)
    one = ensemble.first
    damp(one)
    one.write("/finger/1/position", 0.1)
    one.write("/finger/1/press", 2.0)
    assert np.abs(until_asleep(ensemble)).max() > 1e-4  # it came down
    bent = one.meters()["shapes"][0].copy()
    assert np.abs(bent).max() > 1e-5
    one.write("/output/gain", 6.0)
    heard = run(ensemble, WINDOW // 2)
    assert 0.0 < np.abs(heard).max() < 1e-8
    np.testing.assert_allclose(one.meters()["shapes"][0], bent, atol=1e-9)


# ---------------------------------------------------------------- what keeps it awake


def rest_the_bow(one: Instrument) -> None:
    one.write("/bow/assist", 0.0)
    one.write("/bow/force", 0.5)
    one.write("/bow/side", 1.0)


def move_the_bow_in_the_air(one: Instrument) -> None:
    one.write("/bow/speed", 0.1)


def hold_a_key_in_silence(one: Instrument) -> None:
    one.post(WRITE, index=PLAYING.expression, value=0.0)
    one.post(BEGIN, value=69.0, other=69.0)


def play_a_tremolo(one: Instrument) -> None:
    one.post(WRITE, index=PLAYING.tremolo, value=8.0)
    one.post(BEGIN, value=69.0, other=69.0)


def rock_a_finger(one: Instrument) -> None:
    one.write("/finger/1/press", 2.0)
    one.write("/vibrato/depth", 20.0)


@pytest.mark.parametrize(
    "do",
    [rest_the_bow, move_the_bow_in_the_air, hold_a_key_in_silence, play_a_tremolo, rock_a_finger],
)
def test_it_stays_awake_while_a_hand_plays(do: Callable[[Instrument], None]):
    ensemble = alone(RATE)
    do(ensemble.first)
    run(ensemble, 60 * WINDOW, 1024)
    assert slept(ensemble.first) == 0


@pytest.mark.parametrize("loss", [0.25, 4.0])
def test_a_string_is_heard_until_nobody_could_hear_it(loss):
    ensemble = alone(RATE)
    one = ensemble.first
    one.write("/string/inner/loss", loss, ramp_ms=0.0)
    pluck(one, FROM)
    run(ensemble, WINDOW)
    heard = until_asleep(ensemble, most_s=60.0)
    *before, last = heard  # the first frame asleep
    assert 0.0 < np.abs(before[-WINDOW:]).max() < QUIET
    assert last == 0.0
    assert not run(ensemble, WINDOW).any()


@pytest.mark.parametrize("level", [0.05, 1.0])
def test_a_room_is_heard_until_nobody_could_hear_it(level):
    ensemble = Ensemble([InstrumentSpec(RATE)])
    damp(ensemble.first)
    ensemble.first.write("/room/level", level, ramp_ms=0.0)
    ensemble.first.write("/room/decay", 5.0, ramp_ms=0.0)
    pluck(ensemble.first, FROM)
    ensemble.process(np.zeros((FROM + 100, 2), np.float32))
    piece, peaks = np.zeros((1024, 2), np.float32), []
    while ensemble._stage["room"]["is_asleep"] == 0:
        ensemble.process(piece)
        peaks.append(np.abs(piece).max())
        assert ensemble.frame < 40 * RATE
    assert is_asleep(ensemble.first)
    assert slept(ensemble.first) > RATE  # of itself, while the room went on
    assert 0.0 < np.max(peaks[-9:-1]) < 1e-9
    ensemble.process(piece)
    assert not piece.any()


def test_what_a_low_gain_hid_is_not_heard_where_the_gains_are_raised_in_sleep():
    ensemble = alone(RATE)
    one = ensemble.first
    damp(one)
    one.write("/body/gain", -24.0, ramp_ms=0.0)
    one.write("/output/gain", -60.0, ramp_ms=0.0)
    pluck(one, FROM)
    run(ensemble, FROM)
    until_asleep(ensemble)
    one.write("/body/gain", 24.0)
    one.write("/output/gain", 24.0)
    heard = run(ensemble, WINDOW)
    assert 0.0 < np.abs(heard).max() < 2.0**-24  # half a step of 24 bits
