"""``yehu.body``: bodies are looked at, fitted, kept and played."""

import subprocess

import matplotlib as mpl
import numpy as np
import pytest
import soundfile
from lab.body import bodies

import yehu_server as yehu
from yehu_lab.body import fit, fitting_process
from yehu_server.playing import calibration_store


def test_the_measured_body_is_known_in_closed_form():
    body = yehu.body.load()
    hz = np.geomspace(100.0, 6000.0, 50)
    np.testing.assert_allclose(body.admittance(hz), bodies.admittance(hz), rtol=1e-9)
    np.testing.assert_allclose(body.radiation(hz), bodies.radiation(hz), rtol=1e-9)
    np.testing.assert_allclose(body.modes.mass, bodies.MASS)
    np.testing.assert_allclose(body.modes.resistance, bodies.DAMPING)
    assert body.admittance(440.0) == pytest.approx(bodies.admittance([440.0])[0])
    assert np.shape(body.radiation(np.full((2, 3), 440.0))) == (2, 3)
    assert repr(body) == "<yehu_server.body.Body of 11 modes and 25 sections>"


def test_a_body_of_files_is_fitted_drawn_kept_and_played(tmp_path, monkeypatch):
    mpl.use("Agg")
    taps = yehu.body.made_taps(count=3, noise_db=60.0, seconds=0.4)
    names = [str(tmp_path / f"{number}.wav") for number in range(len(taps))]
    for name, tap in zip(names, taps, strict=True):
        columns = np.stack([tap.force / 40.0, tap.velocity], axis=1)
        soundfile.write(name, columns, round(tap.rate), subtype="FLOAT")
    measured = yehu.body.read(names, channels="force=40,velocity=1")
    found = yehu.body.fit(measured, band_hz=(300.0, 1000.0), modes=np.int64(4))
    assert (len(found.modes.mass), found.band_hz) == (4, (300.0, 1000.0))
    assert found.admittance(439.0) == pytest.approx(bodies.admittance([439.0])[0], rel=0.02)
    assert any("radiation" in line for line in found.warnings)
    assert {ax.get_ylabel() for ax in found.plot().axes} >= {"admittance\ndB of 1 s/kg"}
    written = found.save(str(tmp_path / "mine.toml"))
    again = yehu.body.load(str(tmp_path / "mine.toml"))
    assert (again.body, again.warnings) == (found.body, found.warnings)
    assert len(written) == 2
    monkeypatch.setattr(calibration_store, "data_folder", lambda: tmp_path)
    usual = calibration_store.calibration_for(44100.0)
    monkeypatch.setattr(
        calibration_store.calibration, "calibrate", lambda *_, **__: usual
    )  # it is not heard
    fiddle = yehu.Instrument(instrument=found)
    assert fiddle.quantities.body == yehu.body.load(fiddle.quantities).body == found.body


def test_a_fit_is_made_in_a_process_with_one_thread_and_what_it_finds_is_the_same(
    refused, monkeypatch
):
    measured = yehu.body.average(yehu.body.made_taps(count=2, seconds=0.3))
    how = {"band_hz": (300.0, 1000.0), "sections": 4}
    here = fit(measured, **how)
    given, run = [], subprocess.run

    def heard(*words, env, **more):
        given.append(env[fitting_process.THREADS])
        return run(*words, env=env, **more)

    monkeypatch.delenv(fitting_process.THREADS)
    monkeypatch.setattr(subprocess, "run", heard)
    hz = yehu.body.fit(measured, **how).modes.frequency_hz
    np.testing.assert_allclose(hz, here.modes.frequency_hz, rtol=1e-9)
    refused("nothing was measured", yehu.body.fit, yehu.body.load().measurement)
    assert given == ["1", "1"]
    monkeypatch.setattr(subprocess, "run", lambda *_, **__: subprocess.CompletedProcess((), -9))
    refused("ended with code -9", yehu.body.fit, measured)
    monkeypatch.setattr(subprocess, "run", lambda *_, **__: open("/no/such"))  # noqa: SIM115, PTH123
    refused("cannot be started: no such file", yehu.body.fit, measured)


def test_what_is_wrong_is_reported_in_one_line(refused):
    measured = yehu.body.load().measurement
    refused("such.toml", yehu.body.load, "/no/such.toml")
    refused("source", yehu.body.load, 7)
    refused("measurement", yehu.body.fit, "tap1.wav")
    refused("list of paths", yehu.body.read, "tap1.wav")
    refused("nothing was measured", yehu.body.fit, measured)
    refused("modes", yehu.body.fit, measured, modes=65)
    refused("band_hz", yehu.body.fit, measured, band_hz=(1.0, np.nan))


@pytest.mark.parametrize(
    "call",
    [
        lambda: yehu.body.read([]),
        lambda: yehu.body.read(7),
        lambda: yehu.body.read([None]),
        lambda: yehu.body.made_taps(count=-1),
        lambda: yehu.body.made_taps(count=2.5),
        lambda: yehu.plot.schelleng(None),
    ],
)
def test_wrong_arguments_of_the_laboratory_are_errors_in_one_line(call):
    with pytest.raises(yehu.YehuError) as raised:
        call()
    assert "\n" not in str(raised.value)
