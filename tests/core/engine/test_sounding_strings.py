"""Strings tuned and damped while they sound, and uneven bow hair."""

import numpy as np
import pytest
from pitch import cents, pitch_of
from sound import run_for

from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.spec import InstrumentSpec

RATE = 44100
STRINGS = [("inner", 1.0, 346.0), ("outer", -1.0, 516.0)]
each_string = pytest.mark.parametrize(("name", "side", "about_hz"), STRINGS)


def bow(side: float, **options) -> Instrument:
    instrument = Instrument(InstrumentSpec(RATE, **options))
    instrument.write("/bow/side", side)
    instrument.write("/bow/speed", 0.2, ramp_ms=40.0)
    return instrument


def loudness(out: np.ndarray) -> float:
    return float(20.0 * np.log10(np.sqrt(np.mean(np.square(out, dtype=np.float64)))))


@each_string
@pytest.mark.parametrize("tuning", [-200.0, -50.0, 40.0])
def test_a_string_is_tuned_by_cents_while_it_sounds_and_the_other_keeps_its_own(
    name, side, about_hz, tuning
):
    instrument = bow(side)

    def pitch() -> float:
        return pitch_of(run_for(instrument, 1.0)[-RATE // 4 :], RATE, 200.0)

    before = pitch()
    assert before == pytest.approx(about_hz, rel=0.02)
    other = {"inner": "outer", "outer": "inner"}[name]
    instrument.write(f"/string/{other}/tuning", -150.0)
    assert cents(pitch(), before) == pytest.approx(0.0, abs=6.0)
    instrument.write(f"/string/{other}/tuning", 0.0)
    instrument.write(f"/string/{name}/tuning", tuning)
    # The body's modes pull what the tension asks for.
    assert cents(pitch(), before) == pytest.approx(tuning, abs=20.0)


@pytest.mark.parametrize("frame", [3000, 3010, 3072])
def test_a_string_is_another_at_the_very_sample(frame):
    def heard(tuning: float) -> np.ndarray:
        instrument = bow(1.0)
        instrument.write("/string/inner/tuning", tuning, frame=frame, ramp_ms=0.0)
        return run_for(instrument, 0.1)

    assert np.flatnonzero(heard(0.0) != heard(-50.0))[0] == frame


def test_tuning_while_it_sounds_makes_no_click():
    def steps(retuned: bool) -> float:
        instrument = bow(1.0)
        run_for(instrument, 1.0)
        if retuned:
            instrument.write("/string/inner/tuning", -100.0)
            instrument.write("/string/inner/loss", 2.0)
        return float(np.abs(np.diff(run_for(instrument, 0.3))).max())

    assert steps(retuned=True) < 1.3 * steps(retuned=False)


@pytest.mark.parametrize(("name", "side"), [row[:2] for row in STRINGS])
def test_a_damped_string_dies_away_sooner(name, side):
    def left(loss: float) -> float:
        instrument = Instrument(InstrumentSpec(RATE))
        instrument.write(f"/string/{name}/loss", loss, ramp_ms=0.0)
        instrument.write("/pluck/force", 1.0 * side)
        run_for(instrument, 0.6)
        return loudness(run_for(instrument, 0.2))

    lively, usual, damped = (left(loss) for loss in (0.25, 1.0, 4.0))
    assert lively > usual + 1.0
    assert usual > damped + 6.0


@pytest.mark.parametrize("rate", [22050, 44100, 192000])
@pytest.mark.parametrize("tuning", [-200.0, 40.0])
@pytest.mark.parametrize("loss", [0.25, 4.0])
def test_every_tuning_and_loss_is_stable(rate, tuning, loss):
    instrument = Instrument(InstrumentSpec(rate))
    for name, _, _ in STRINGS:
        instrument.write(f"/string/{name}/tuning", tuning, ramp_ms=0.0)
        instrument.write(f"/string/{name}/loss", loss, ramp_ms=0.0)
    for finger, place in ((1, 0.08), (2, 0.15)):
        instrument.write(f"/finger/{finger}/position", place)
        instrument.write(f"/finger/{finger}/press", 5.0)
    instrument.write("/bow/side", 1.0)
    instrument.write("/bow/speed", 0.3)
    run_for(instrument, 0.2)
    instrument.write("/bow/speed", 0.0)
    for finger in (1, 2):
        instrument.write(f"/finger/{finger}/press", 0.0)
    instrument.write("/pluck/force", 3.0)
    loud = run_for(instrument, 0.3)
    ringing = run_for(instrument, 0.3)
    assert instrument.lost_states == 0
    assert np.abs(loud).max() > 0.01
    assert loudness(ringing) < loudness(loud)
