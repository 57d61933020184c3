"""Measurements from sound files, tables and universal files: the same body out of each."""

import warnings
from itertools import cycle, product

import numpy as np
import pytest
import soundfile
from lab.body.bodies import admittance, off_db, radiation, rms

from yehu_lab.body import plausible, read, tables
from yehu_lab.body.tap import write_taps
from yehu_server.errors import MeasurementError

HZ = np.arange(100.0, 5000.0, 10.0)
Y = admittance(HZ)
TURN = 2j * np.pi * HZ


@pytest.fixture(autouse=True)
def _quickly(monkeypatch):
    """Look at fewer lines of what is read: test_plausible.py looks at all."""
    monkeypatch.setattr(plausible, "LINES", 60)


def table(path, headings, *columns, mark=",", decimal="."):
    lines = [mark.join(headings)]
    lines += [
        mark.join(repr(float(value)).replace(".", decimal) for value in row)
        for row in zip(*columns, strict=True)
    ]
    path.write_text("\n".join(lines) + "\n")
    return path


def assert_is_the_yehu(curve, most_db=1e-6):
    assert rms(off_db(curve.values, admittance(curve.frequency_hz))) < most_db


# ---------------------------------------------------------------- sound files


def test_taps_are_read_from_sound_files(taps, tmp_path):
    files, channels = write_taps(taps, tmp_path / "taps")
    measured = read(files, channels=channels)
    assert measured.admittance.taps == 5
    assert measured.sources == tuple(f"tap{i}.wav" for i in range(1, 6))
    curve = measured.admittance.within(200.0, 5000.0)
    assert rms(off_db(curve.values, admittance(curve.frequency_hz))) < 0.1
    curve = measured.radiation.within(300.0, 4000.0)
    assert rms(off_db(curve.values, radiation(curve.frequency_hz))) < 0.3


def test_channels_are_scaled_and_may_be_skipped(taps, tmp_path):
    tap = taps[0]
    columns = [tap.pressure / 8.0, tap.force / -32.0, tap.velocity / 1e-3 / 2e3]
    soundfile.write(tmp_path / "tap.wav", np.stack(columns, 1), 44100, "FLOAT")
    measured = read([tmp_path / "tap.wav"], channels="none,force=-32,velocity=2")
    assert measured.radiation is None
    curve = measured.admittance.within(200.0, 4000.0)
    assert rms(off_db(curve.values, admittance(curve.frequency_hz))) < 0.2


def test_wrong_channels_are_reported(taps, tmp_path):
    files, _ = write_taps(taps[:1], tmp_path / "taps")
    for channels, told in (
        (None, "--channels"),
        ("force=32,velocity=1", "has 3 channels, not 2"),
        ("force=32,speed=1,pressure=8", "unknown quantity 'speed'"),
        ("force=32,force=1,pressure=8", "force is given twice"),
        ("force=32,velocity=0,pressure=8", "other than 0"),
        ("force=32,velocity=nan,pressure=8", "other than 0"),
        ("force=32,velocity=x,pressure=8", "other than 0"),
        ("none,velocity=1,pressure=8", "needs a force"),
        ("force=32,velocity=1,acceleration=8", "one of velocity"),
    ):
        with pytest.raises(MeasurementError, match=told):
            read(files, channels=channels)


def test_files_that_claim_or_hold_too_much_are_refused_before_they_are_read(tmp_path, monkeypatch):
    frames = 48000
    silence = tmp_path / "tap.flac"
    soundfile.write(silence, np.zeros((frames, 2)), 48000, format="FLAC")
    data = bytearray(silence.read_bytes())
    data[22:26] = (500 * 48000).to_bytes(4, "big")  # the number of frames that its header tells
    silence.write_bytes(data)
    with pytest.raises(MeasurementError, match="has 48000000 samples, more than"):
        read([silence], channels="force=1,velocity=1")
    monkeypatch.setattr(tables, "MAX_NUMBERS", 1000)
    (tmp_path / "tap.csv").write_text("time_s,force_N,velocity_m/s\n" + "0,0,0\n" * 400)
    with pytest.raises(MeasurementError, match="has more than 1000 numbers"):
        read([tmp_path / "tap.csv"])


# ---------------------------------------------------------------- tables


def test_responses_are_read_however_they_are_written(tmp_path):
    written = [
        (("frequency_hz", "mobility_real", "mobility_imag"), (Y.real, Y.imag)),
        (("Frequency (Hz)", "Re. real part of admittance", "imag"), (Y.real, Y.imag)),
        (("freq", "magnitude mobility", "phase_deg"), (np.abs(Y), np.degrees(np.angle(Y)))),
        (("freq", "abs mobility", "phase_rad"), (np.abs(Y), np.angle(Y))),
        (("freq", "level_db admittance", "phase deg"),
         (20.0 * np.log10(np.abs(Y)), np.degrees(np.angle(Y)))),
        (("freq", "receptance real", "imag"), ((Y / TURN).real, (Y / TURN).imag)),
        (("freq", "accelerance real", "imag"), ((Y * TURN).real, (Y * TURN).imag)),
        (("freq", "inertance magnitude_db", "phase_deg"),
         (20.0 * np.log10(np.abs(Y * TURN)), np.degrees(np.angle(Y * TURN)))),
    ]  # fmt: skip
    marks = [(",", "."), (";", ","), ("\t", ".")]
    for (headings, columns), (mark, decimal) in zip(written, cycle(marks), strict=False):
        path = table(tmp_path / "y.csv", headings, HZ, *columns, mark=mark, decimal=decimal)
        assert_is_the_yehu(read([path]).admittance)


def test_coherence_is_read_and_two_responses_are_averaged(tmp_path):
    headings = ["frequency_hz", "mobility_real", "mobility_imag", "coherence"]
    coherence = np.where(HZ > 3000.0, 0.5, 1.0)
    columns = ((factor * Y.real, factor * Y.imag, coherence) for factor in (1.5, 0.5))
    paths = [table(tmp_path / f"{n}.csv", headings, HZ, *each) for n, each in enumerate(columns)]
    measured = read(paths)
    assert_is_the_yehu(measured.admittance)
    assert measured.admittance.taps == 2
    assert measured.admittance.coherence.min() == 0.5
    assert any("coherence is below" in line for line in measured.warnings)


def test_taps_are_read_from_tables_with_units(taps, tmp_path):
    sizes = {"mN": 1e-3, "mm/s": 1e-3, "mPa": 1e-3, "(um/s)": 1e-6}
    tap = taps[0]
    time, columns = np.arange(len(tap.force)) / tap.rate, (tap.force, tap.velocity, tap.pressure)
    for units in (["N", "m/s", "mPa"], ["mN", "mm/s", "Pa"], ["(N)", "(um/s)", "(Pa)"]):
        names = map("_".join, zip(("force", "velocity", "pressure"), units, strict=True))
        scaled = (c / sizes.get(unit, 1.0) for c, unit in zip(columns, units, strict=True))
        path = table(tmp_path / "tap.csv", ["time_s", *names], time, *scaled)
        curve = read([path]).admittance.within(200.0, 4000.0)
        assert rms(off_db(curve.values, admittance(curve.frequency_hz))) < 0.2, units


def test_wrong_tables_are_reported(tmp_path, subtests):
    numbers = "\n".join(f"{100 + n},1.0,2.0" for n in range(40))
    for text, told in (
        ("", "0 lines"),
        ("f,real,imag\n1,2,3", "2 lines"),
        (numbers, "names no columns"),
        (f"height,real,imag\n{numbers}", "neither time nor frequency"),
        (f"f,real mobility\n{numbers}", "2 columns, but not in"),
        (f"f,real mobility,other\n{numbers}", "real and imag"),
        (f"f,magnitude mobility,phase\n{numbers}", "phase_deg or phase_rad"),
        (f"f,real mobility,imag\n{numbers}\n7,x,1", "no numbers in"),
        (f"f,real mobility,imag\n{numbers}\n7,nan,1", "not finite"),
        (f"f,real mobility,imag\n{numbers}\n100,1,1", "two at one frequency"),
        (f"t,force,velocity_kn\n{numbers}", "unknown unit"),
        (f"t,force,force\n{numbers}", "given twice"),
        (f"t,force,velocity\n{numbers}\n7,1,1", "not evenly spaced"),
    ):
        with subtests.test(told):
            (tmp_path / "x.csv").write_text(text)
            with pytest.raises(MeasurementError, match=told) as error:
                read([tmp_path / "x.csv"])
            assert "x.csv" in str(error.value)


def test_missing_and_foreign_files_are_reported(tmp_path):
    for name in ("x.wav", "x.csv", "x.uff", "x.mp9"):
        for make in (bool, (tmp_path / name).mkdir):  # it is missing, and a folder
            make()
            with pytest.raises(MeasurementError, match="x"):
                read([tmp_path / name])


# ---------------------------------------------------------------- universal files


def universal(path, *sets):
    import pyuff

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        pyuff.UFF(str(path)).write_sets(list(sets), "add")
    return path


def data_set(values, x=HZ, kind=11, func=4, **more):
    entry = {
        "type": 58, "func_type": func, "rsp_node": 1, "rsp_dir": 3, "ref_node": 1, "ref_dir": 3,
        "data": values, "x": x, "id1": "id1", "rsp_ent_name": "NONE", "ref_ent_name": "NONE",
        "abscissa_spacing": 1, "abscissa_min": float(x[0]), "abscissa_inc": float(x[1] - x[0]),
        "num_pts": len(x), "ord_data_type": 6 if np.iscomplexobj(values) else 4,
        "abscissa_spec_data_type": 18 if func == 4 else 17, "ordinate_spec_data_type": kind,
        "orddenom_spec_data_type": 13, "binary": 0,
    }  # fmt: skip
    return entry | more


UNITS_MM = {"type": 164, "units_code": 5, "units_description": "mm", "temp_mode": 1,
            "length": 1e3, "force": 1.0, "temp": 1.0, "temp_offset": 0.0}  # fmt: skip


def test_universal_files_tell_what_they_hold(tmp_path):
    kinds = ((11, Y), (8, Y / TURN), (12, Y * TURN))
    for (kind, values), binary in product(kinds, (0, 1)):
        name = tmp_path / f"{kind}-{binary}.uff"
        path = universal(name, data_set(values, kind=kind, binary=binary))
        assert_is_the_yehu(read([path]).admittance, 1e-3)


def test_units_of_universal_files_count(tmp_path):
    path = universal(
        tmp_path / "y.uff", UNITS_MM, data_set(1e3 * Y), data_set(1e-6 * radiation(HZ), kind=15)
    )
    measured = read([path])
    assert_is_the_yehu(measured.admittance, 1e-3)
    assert rms(off_db(measured.radiation.values, radiation(HZ))) < 1e-3


def test_the_driving_point_is_chosen_and_its_direction_minded(tmp_path):
    path = universal(
        tmp_path / "y.uff",
        data_set(3.0 * Y, rsp_node=2),
        data_set(-Y, rsp_dir=-3),
        data_set(np.where(HZ > 200.0, 1.0, 0.25), func=6),
    )
    measured = read([path])
    assert_is_the_yehu(measured.admittance, 1e-3)
    assert measured.admittance.coherence.min() == pytest.approx(0.25)
    elsewhere = universal(tmp_path / "z.uff", data_set(Y, rsp_node=2), data_set(Y, rsp_dir=1))
    with pytest.raises(MeasurementError, match="where the hammer struck"):
        read([elsewhere])


def test_taps_are_read_from_universal_files(taps, tmp_path):
    sets = []
    for tap in taps[:3]:
        time = np.arange(len(tap.force)) / tap.rate
        sets += [data_set(tap.force, time, 13, 1), data_set(tap.velocity, time, 11, 1)]
    measured = read([universal(tmp_path / "taps.uff", *sets)])
    assert measured.admittance.taps == 3
    curve = measured.admittance.within(200.0, 4000.0)
    assert rms(off_db(curve.values, admittance(curve.frequency_hz))) < 0.2


def test_a_data_set_that_ends_early_is_reported(tmp_path):
    path = universal(tmp_path / "y.uff", data_set(Y))
    lines = path.read_text().splitlines()
    path.write_text("\n".join([*lines[:-20], lines[-1]]) + "\n")
    with pytest.raises(MeasurementError, match="says 490"):
        read([path])
