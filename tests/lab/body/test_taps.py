"""Taps: cut out of recordings, faults seen, and averaged with coherence."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from lab.body.bodies import admittance, clipped, hit_twice, off_db, rms, with_velocity_only

from yehu_lab.body import Curve, average, made_taps
from yehu_lab.body.average import average_taps, hammer_reach
from yehu_lab.body.tables import Response
from yehu_lab.body.tap import cut
from yehu_server.errors import MeasurementError

RATE = 44100.0


def looked_at(tap):
    """The tap as a recording of it is read."""
    (found,) = cut(tap.rate, {"force": tap.force, **tap.responses}, tap.name)
    return found


def half_sine(contact_s, frames=20_000, at=2000):
    """A hit of 10 N, and how a mass of 10 g flies off."""
    time = (np.arange(frames) - at) / RATE
    inside = (time >= 0.0) & (time <= contact_s)
    force = np.where(inside, 10.0 * np.sin(np.pi * time / contact_s), 0.0)
    return force, np.cumsum(force) / RATE / 0.01


# ---------------------------------------------------------------- cutting


def test_one_recording_may_hold_several_taps(taps):
    whole = {
        "force": np.concatenate([tap.force for tap in taps[:3]]),
        "velocity": np.concatenate([tap.velocity for tap in taps[:3]]),
    }
    found = cut(taps[0].rate, whole, "all.wav")
    assert [tap.name for tap in found] == ["all.wav, tap 1", "all.wav, tap 2", "all.wav, tap 3"]
    assert not any(tap.faults for tap in found)
    for own, tap in zip(found, taps, strict=False):
        assert np.abs(own.force).max() == pytest.approx(np.abs(tap.force).max(), rel=0.01)


def test_what_is_no_tap_is_reported():
    force = half_sine(3e-4)[0]
    for channels, told in (
        ({"force": np.zeros(9000), "velocity": np.ones(9000)}, "no hit"),
        ({"force": np.sin(np.arange(9000.0)), "velocity": np.ones(9000)}, "no hit"),
        ({"force": force}, "needs a force and a response"),
        ({"velocity": force}, "needs a force and a response"),
        ({"force": force, "velocity": np.full(20_000, np.nan)}, "not finite"),
        ({"force": force[:3000], "velocity": np.ones(3000)}, "ends within"),
    ):
        with pytest.raises(MeasurementError, match=f"x.wav: .*{told}"):
            cut(RATE, channels, "x.wav")


# ---------------------------------------------------------------- faults


def test_good_taps_have_no_faults(taps):
    assert [looked_at(tap).faults for tap in taps] == [()] * 5


def test_soft_and_hard_hammers_are_no_fault():
    random = np.random.default_rng(0)
    for contact_s in (1e-4, 2e-4, 5e-4, 1.5e-3):
        force, velocity = half_sine(contact_s)
        force = force + 0.01 * random.standard_normal(len(force))
        velocity = velocity * np.exp(-np.arange(20_000) / 500)
        (tap,) = cut(RATE, {"force": force, "velocity": velocity}, "")
        assert tap.faults == (), contact_s


def test_a_clipped_tap_is_seen_and_left_out(taps):
    force = taps[0].force.clip(-1.0, 0.7 * taps[0].force.max())
    assert looked_at(replace(taps[0], force=force)).faults == ("its force is clipped",)
    faulty = looked_at(clipped(with_velocity_only(taps[2])))
    assert faulty.faults == ("its velocity is clipped",)
    others = [with_velocity_only(tap) for tap in taps if tap is not taps[2]]
    measured = average([*others, faulty])
    assert measured.admittance.taps == 4
    assert any("left out, its velocity is clipped" in line for line in measured.warnings)


def test_a_double_hit_is_seen(taps):
    for after_s, size in product((0.002, 0.01, 0.1), (0.15, 0.3, 0.8)):
        assert "the hammer hit twice" in looked_at(hit_twice(taps[0], after_s, size)).faults


def test_strings_that_are_not_damped_are_no_drift_or_hum(taps):
    """Strings of 349 Hz and its octave, 30 dB below the body, that ring for seconds."""

    def strings(time):
        ring = sum(np.sin(2.0 * np.pi * hz * (time - 0.02)) for hz in (349.2, 698.4))
        return 10.0 ** (-30.0 / 20.0) * (time > 0.02) * ring * np.exp(-1.5 * (time - 0.02))

    usual = average(taps).warnings
    for more, told in (
        (strings, "damp them"),
        (lambda time: 0.3 * np.expm1(-time / 0.3), "the sensor drifts"),
        (lambda time: 0.3 * np.sin(950.0 * time), "swings before the hit"),
    ):
        found = []
        for tap in taps:
            added = np.abs(tap.velocity).max() * more(np.arange(len(tap.force)) / tap.rate)
            found.append(looked_at(replace(tap, responses={"velocity": tap.velocity + added})))
        lines = average_taps(found).warnings
        assert any(told in line for line in lines)
        assert any("rings" in line for line in lines) == (more is strings), lines
        assert not any(told in line for line in usual)


def test_the_mass_of_an_accelerometer_is_taken_off():
    """A mass on the bridge takes j omega m Y of each newton: Y/(1 + j omega m Y) is measured."""
    hz = np.arange(100.0, 5000.0, 1.0)
    turn = 2j * np.pi * hz
    mass = 1e-3
    loaded = admittance(hz) / (1.0 + turn * mass * admittance(hz))
    assert np.abs(off_db(loaded, admittance(hz))).max() > 3.0
    measured = [Response(Curve(hz, loaded * turn), "accelerance")]
    curve = average([], measured, sensor_mass=mass).admittance
    assert np.abs(off_db(curve.values, admittance(hz))).max() < 1e-6
    told = "accelerometer's mass"
    assert any(told in line for line in average([], measured).warnings)
    assert not any(told in line for line in average([], measured, sensor_mass=0.0).warnings)
    with pytest.raises(MeasurementError, match="sensor_mass"):
        average([], measured, sensor_mass=1.0)


def test_the_hammer_reaches_to_where_its_spectrum_has_fallen():
    """First-order low-pass power: 25 dB down at 17.8 times the corner."""
    hz = np.linspace(0.0, 22_050.0, 5000)
    power = 1.0 / (1.0 + (hz / 300.0) ** 2)
    assert hammer_reach(hz, power) == pytest.approx(300.0 * (10.0**2.5 - 1.0) ** 0.5, rel=0.01)


# ---------------------------------------------------------------- averages


def test_the_average_is_the_admittance(taps):
    """As far as noise 60 dB below allows."""
    curve = average(taps).admittance.within(200.0, 5000.0)
    assert rms(off_db(curve.values, admittance(curve.frequency_hz))) < 0.1
    assert np.median(curve.coherence) > 0.999


@pytest.mark.parametrize("what", ["acceleration", "displacement"])
def test_accelerometers_and_displacements_give_the_same_admittance(what):
    """Made of the velocity by a derivative or an integral in the spectrum."""
    converted = []
    for tap in made_taps(noise_db=120.0):
        velocity = tap.velocity - tap.velocity[:500].mean()
        turn = 2j * np.pi * np.fft.rfftfreq(len(velocity), 1.0 / tap.rate)
        turn[0] = 1.0
        power = 1 if what == "acceleration" else -1
        values = np.fft.irfft(np.fft.rfft(velocity) * turn**power, len(velocity))
        converted.append(replace(tap, responses={what: values}))
    curve = average(converted).admittance.within(200.0, 5000.0)
    assert rms(off_db(curve.values, admittance(curve.frequency_hz))) < 0.05


def test_noise_of_the_response_does_not_bias_the_average():
    """H1: its mean over many taps is right, where H2's would be too large."""
    measured = average(
        [with_velocity_only(tap) for tap in made_taps(count=24, noise_db=20.0, seconds=0.4)]
    )
    curve = measured.admittance.within(2000.0, 4000.0)
    share = np.mean(curve.values / admittance(curve.frequency_hz))
    assert share == pytest.approx(1.0, abs=0.02)


def test_coherence_tells_of_noise():
    """In a band with noise as strong as the answer, gamma squared of many taps is a half."""
    taps = made_taps(count=24, noise_db=200.0, seconds=0.4)
    random = np.random.default_rng(1)
    hz = np.fft.rfftfreq(len(taps[0].force), 1.0 / taps[0].rate)
    noisy = []
    for tap in taps:
        spectrum = np.fft.rfft(tap.velocity)
        phase = np.exp(2j * np.pi * random.random(len(hz)))
        spectrum = np.where((hz > 1000.0) & (hz < 2000.0), spectrum * (1.0 + phase), spectrum)
        values = np.fft.irfft(spectrum, len(tap.velocity))
        noisy.append(replace(tap, responses={"velocity": values}))
    measured = average(noisy)
    assert np.mean(measured.admittance.within(1050.0, 1950.0).coherence) == pytest.approx(
        0.5, abs=0.1
    )
    assert np.mean(measured.admittance.within(2200.0, 4000.0).coherence) > 0.95
    assert any("coherence is below" in line for line in measured.warnings)
