"""``yehu.simulate`` and ``yehu.sweep``: gestures to arrays."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
import xarray

import yehu_server as yehu
from yehu_server import YehuError
from yehu_server.cli import main

CONTROLS = {"bow_force": [[0.0, 0.0], [0.03, 0.7]], "bow_velocity": [[0.0, 0.0], [0.03, 0.3]]}
GESTURE = {"duration": 0.2, "controls": CONTROLS}
# Half way along the string that is bowed at a quarter: friction theory says nothing of it, and
# the wave speed of table 1 of the paper gives its pitch.
F4 = math.sqrt(50.61 / (1250.0 * math.pi * 0.55e-3**2)) / (2.0 * 0.30)


@pytest.fixture
def file(tmp_path) -> Path:
    path = tmp_path / "gesture.json"
    path.write_text(json.dumps(GESTURE))
    return path


# ---------------------------------------------------------------- simulate


def test_a_file_and_its_data_give_the_arrays_of_the_command(file, tmp_path):
    assert main(["simulate", str(file), "-o", str(tmp_path / "run.npz"), "--energy"]) == 0
    expected = np.load(tmp_path / "run.npz")
    for gesture in (file, str(file), GESTURE):
        found = yehu.simulate(gesture, energy=True)
        assert {*found.arrays, "meta"} == set(expected)
        for name, values in found.arrays.items():
            np.testing.assert_array_equal(values, expected[name], err_msg=name)


def test_a_control_may_have_a_value_for_each_sample():
    t = np.arange(4410) / 44100.0
    force, speed = 0.5 + 0.2 * np.sin(40.0 * t), 0.3 * np.minimum(t / 0.03, 1.0)
    run = yehu.simulate({"controls": {"bow_force": force, "bow_velocity": speed}})
    np.testing.assert_array_equal(run.arrays["bow_force"], force)
    np.testing.assert_array_equal(run.arrays["bow_velocity"], speed)
    assert run.meta["frames"] == 4410


def test_arrays_numbers_and_points_are_the_same_gesture():
    as_lists = yehu.simulate({"duration": 0.05, "controls": {"bow_force": [[0, 0.1], [0.05, 0.9]]}})
    points = np.array([[0.0, 0.1], [0.05, 0.9]])
    as_array = yehu.simulate({"duration": np.float64(0.05), "controls": {"bow_force": points}})
    np.testing.assert_array_equal(as_lists.arrays["bow_force"], as_array.arrays["bow_force"])


def test_a_run_is_saved_by_any_path_and_told_in_a_line(tmp_path):
    run = yehu.simulate(GESTURE)
    run.save(str(tmp_path / "run.npz"))
    assert np.load(tmp_path / "run.npz")["time"].shape == run.arrays["time"].shape
    assert repr(run).startswith("<yehu_server.Simulation of 0.2 s: time, ")


@pytest.mark.parametrize(
    ("gesture", "names"),
    [
        ("/no/such.json", "such.json"),
        (7, "gesture"),
        ({"durations": 1.0}, "durations"),
        ({"controls": {"bow_forse": 1.0}}, "bow_forse"),
        ({"controls": {"bow_force": np.zeros((3, 3))}}, "bow_force"),
        ({"controls": {"bow_force": np.array([0.0, np.nan])}}, "bow_force"),
        ({"controls": {"bow_force": 1e6}}, "bow_force"),
        ({"controls": 5}, "controls"),
        ({"duration": -1.0}, "duration"),
        ({"instrument": {"bow": {"mu_X": 1.0}}}, "mu_X"),
    ],
)
def test_a_wrong_gesture_is_told_in_one_line(gesture, names):
    for act in (yehu.simulate, lambda each: yehu.sweep(each, {"press_force": [0.0, 1.0]})):
        with pytest.raises(YehuError) as refused:
            act(gesture)
        assert names in str(refused.value)
        assert "\n" not in str(refused.value)


# ---------------------------------------------------------------- sweep


@pytest.fixture(scope="module")
def swept() -> yehu.Sweep:
    gesture = {"duration": 0.4, "controls": {"bow_velocity": [[0.0, 0.0], [0.02, 0.15]]}}
    return yehu.sweep(gesture, {"bow_force": [0.005, 0.5], "bow_position": [0.24, 0.255, 0.27]})


def test_what_was_found_has_an_axis_for_each_name(swept):
    assert list(swept.axes) == ["bow_force", "bow_position"]
    assert swept.grid("pitch_hz").shape == (2, 3)
    np.testing.assert_array_equal(swept.axes["bow_position"], [0.24, 0.255, 0.27])


def test_an_ordinary_stroke_is_helmholtz_motion_at_the_pitch_of_the_string(swept):
    regimes, pitches = swept.grid("regime"), swept.grid("pitch_hz")
    assert swept.regimes[regimes[1, 1]] == "helmholtz"
    # Stiff strings on a moving bridge sound a little off the ideal string.
    assert pitches[1, 1] == pytest.approx(F4, rel=0.03)
    assert 0.0 < swept.grid("helmholtz_s")[1, 1] < 0.3


def test_a_bow_that_hardly_touches_makes_no_helmholtz_motion(swept):
    assert "helmholtz" not in {swept.regimes[number] for number in swept.grid("regime")[0]}
    assert (swept.grid("level_db")[0] < swept.grid("level_db")[1]).all()


def test_it_is_the_same_for_any_number_of_workers(swept):
    gesture, vary = swept.meta["gesture"], swept.axes
    again = yehu.sweep(gesture, vary, workers=1)
    for name, column in swept.columns.items():
        np.testing.assert_array_equal(again.columns[name], column)


def test_a_labelled_dataset_has_names_values_and_units(swept):
    found = swept.to_xarray()
    assert isinstance(found, xarray.Dataset)
    assert found.pitch_hz.dims == ("bow_force", "bow_position")
    at = found.sel(bow_force=0.5, bow_position=0.256, method="nearest")
    assert float(at.pitch_hz) == swept.grid("pitch_hz")[1, 1]
    assert found.bow_position.attrs["units"] == "m"
    assert found.regime.attrs["flag_meanings"].split()[2] == "helmholtz"


def test_without_xarray_one_line_says_what_to_install(swept, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "xarray", None)
    with pytest.raises(YehuError, match=r"yehu-server\[lab\]"):
        swept.to_xarray()


def test_progress_is_told():
    told = []
    yehu.sweep(
        {"duration": 0.1}, {"bow_force": [0.1, 0.2]}, progress=lambda *each: told.append(each)
    )
    assert told[-1] == (2, 2)


@pytest.mark.parametrize(
    ("vary", "names"),
    [
        ({}, "vary"),
        ([1.0], "vary"),
        ({"bow_force": 0.5}, "bow_force"),
        ({"bow_force": []}, "bow_force"),
        ({"bow_force": [0.1, "b"]}, "bow_force"),
        ({"bow_force": [1e9]}, "bow_force"),
        ({"no.such": [1.0]}, "no"),
        ({7: [1.0]}, "7"),
        ({"bow_acceleration": [1.0]}, "bow_velocity"),
        ({"bow_force": np.linspace(0, 1, 1001), "press_force": np.linspace(0, 1, 1000)}, "runs"),
    ],
)
def test_wrong_values_are_told_in_one_line(vary, names):
    with pytest.raises(YehuError) as refused:
        yehu.sweep({"duration": 0.05}, vary)
    assert names in str(refused.value)
    assert "\n" not in str(refused.value)
