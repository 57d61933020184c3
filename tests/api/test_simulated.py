"""``yehu.simulate`` and ``yehu.sweep``: gestures to arrays."""

import json
import sys
from pathlib import Path

import numpy as np
import pytest

import yehu_server as yehu
from yehu_server.cli import main
from yehu_server.simulation.run import Simulation
from yehu_server.simulation.run import simulate as run

CONTROLS = {"bow_force": [[0.0, 0.0], [0.03, 0.7]], "bow_velocity": [[0.0, 0.0], [0.03, 0.3]]}
GESTURE = {"duration": 0.2, "controls": CONTROLS}


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


def test_a_control_may_have_a_value_for_each_sample_or_an_array_of_points():
    t = np.arange(4410) / 44100.0
    force, speed = 0.5 + 0.2 * np.sin(40.0 * t), 0.3 * np.minimum(t / 0.03, 1.0)
    run = yehu.simulate({"controls": {"bow_force": force, "bow_velocity": speed}})
    np.testing.assert_array_equal(run.arrays["bow_force"], force)
    np.testing.assert_array_equal(run.arrays["bow_velocity"], speed)
    assert run.meta["frames"] == 4410
    points = [[0.0, 0.1], [0.05, 0.9]]
    runs = [
        yehu.simulate({"duration": np.float64(0.05), "controls": {"bow_force": each}})
        for each in (points, np.array(points))
    ]
    np.testing.assert_array_equal(*(each.arrays["bow_force"] for each in runs))


def test_a_run_whose_friction_was_not_solved_says_so(monkeypatch):
    def unsolved(*arguments, **named):
        found = run(*arguments, **named)
        return Simulation(found.arrays, {**found.meta, "unconverged_solves": 3})

    monkeypatch.setattr("yehu_server.api.simulated.run", unsolved)
    with pytest.warns(RuntimeWarning, match="^3 unconverged solves, 0 lost states$"):
        yehu.simulate({"duration": 0.01})


def test_four_fingers_stop_the_strings_and_their_ledger_closes():
    fingers = {"finger_position": 0.05, "press_force": 1.5}
    for finger in (2, 3, 4):
        fingers[f"finger_position_{finger}"] = 0.02 + 0.04 * finger
        fingers[f"press_force_{finger}"] = [[0.0, 0.0], [0.02 * finger, 0.0], [0.1, 2.0]]
    arrays = yehu.simulate({"duration": 0.5, "controls": CONTROLS | fingers}, energy=True).arrays
    assert arrays["contact_force"].shape == (22050, 4, 2)
    pressed = arrays["contact_force"][-441:].mean(axis=0).sum(axis=1)
    assert pressed == pytest.approx([1.5, 2.0, 2.0, 2.0], rel=0.1)  # both strings bear the press
    assert np.abs(arrays["energy_error"]).max() < 1e-9 * arrays["power_in"].max()
    for name in ("finger", "friction", "strings", "bridge", "hair"):
        assert arrays[f"loss_{name}"].min() > -1e-8
    one = yehu.simulate({"duration": 0.02, "controls": CONTROLS}).arrays
    unused = CONTROLS | {"press_force_4": 0.0}
    four = yehu.simulate({"duration": 0.02, "controls": unused}).arrays
    np.testing.assert_allclose(four["bridge_force"], one["bridge_force"], atol=1e-12)


def test_a_sweep_may_be_of_notes_places_and_strings(refused):
    vary = {"string": [1, 2], "note": [77, 79], "position": [0.1, 0.13]}
    found = yehu.sweep({"stroke": {"speed": 0.2}, "duration": 0.1}, vary)
    assert found.grid("regime").shape == (2, 2, 2)
    assert list(found.axes) == list(vary)
    refused("stroke.sped: unknown entry", yehu.sweep, {"stroke": {"sped": 0.2}}, vary)
    two = {"controls": {"press_force_2": 1.0}}
    refused("a sweep has one finger", yehu.sweep, two, {"bow_force": [0.5]})


def test_a_run_is_saved_by_any_path_and_reported_in_a_line(tmp_path, refused):
    run = yehu.simulate(GESTURE)
    run.save(str(tmp_path / "run.npz"))
    refused("run.npz: exists; --overwrite", run.save, tmp_path / "run.npz")
    run.save(tmp_path / "run.npz", overwrite=True)
    refused("run.wav: arrays are written; name an .npz file", run.save, tmp_path / "run.wav")
    assert np.load(tmp_path / "run.npz")["time"].shape == run.arrays["time"].shape
    assert repr(run) == f"<yehu_server.Simulation of 0.2 s at 44100 Hz, {len(run.arrays)} arrays>"
    again = yehu.Simulation.load(str(tmp_path / "run.npz"))
    assert again.meta == run.meta
    assert set(again.arrays) == set(run.arrays)
    np.testing.assert_array_equal(again.arrays["pressure"], run.arrays["pressure"])


def test_a_run_is_a_data_set_with_units_coordinates_and_where_it_came_from():
    run = yehu.simulate(GESTURE, energy=True, strings_every=100)
    found = run.to_xarray()
    assert set(found.variables) == set(run.arrays) | {"string"}
    assert [name for name in found.variables if not found[name].attrs.get("units")] == ["string"]
    assert found.string_2.dims == ("strings_time", "x_2")
    assert found.contact_force.dims == ("time", "string")
    assert found.bridge_velocity.attrs["units"] == "m s-1"
    told = found.attrs
    assert told["source"] == f"yehu-server {yehu.__version__}"
    assert (told["sample_rate"], told["seed"]) == (44100.0, 0)
    assert json.loads(told["instrument"])["bow"]["mu_S"] == 1.0207
    assert json.loads(told["gesture"])["controls"].keys() == GESTURE["controls"].keys()
    assert all(isinstance(value, str | int | float) for value in told.values())
    assert (
        told["sha256"] == yehu.simulate(GESTURE, energy=True, strings_every=100).to_xarray().sha256
    )
    other = yehu.simulate(GESTURE | {"instrument": {"bow": {"mu_S": 1.02}}})
    assert other.to_xarray().sha256 != told["sha256"]


def test_an_array_of_another_length_or_a_wrong_gesture_is_refused(refused):
    force, short = {"bow_force": np.ones(90)}, {"duration": 0.05}
    for gesture, names in (
        (short | {"controls": {"bow_force": np.ones(100)}}, "100 samples, but 0.05 s"),
        (short | {"controls": {"bow_force": np.ones(4410)}}, "bow_force: 4410 samples"),
        ({"controls": force | {"bow_velocity": np.ones(91)}}, "91 samples, but bow_force"),
        ({"controls": force, "duration": "long"}, "duration"),
        ({"controls": {"bow_forse": 1.0}}, "bow_forse"),
        ({"controls": {"bow_force": np.zeros((3, 3))}}, "bow_force"),
        ({"controls": {"bow_force": np.array([0.0, np.nan])}}, "bow_force"),
        ({"controls": 5}, "controls"),
        ("/no/such.json", "such.json"),
        (7, "gesture"),
    ):
        refused(names, yehu.simulate, gesture)
        refused(names, yehu.sweep, gesture, {"press_force": [0.0, 1.0]})


# ---------------------------------------------------------------- sweep


@pytest.fixture(scope="module")
def swept() -> tuple[yehu.Sweep, list[tuple[int, int]]]:
    """A sweep, and its progress."""
    gesture = {"duration": 0.4, "controls": {"bow_velocity": [[0.0, 0.0], [0.02, 0.15]]}}
    vary, done = {"bow_force": [0.005, 0.5], "bow_position": [0.24, 0.255, 0.27]}, []
    return yehu.sweep(gesture, vary, progress=lambda *each: done.append(each)), done


def test_a_labelled_dataset_has_names_values_and_units(swept, tmp_path):
    xarray = pytest.importorskip("xarray")
    swept, _ = swept
    found = swept.to_xarray()
    assert isinstance(found, xarray.Dataset)
    assert found.pitch_hz.dims == ("bow_force", "bow_position")
    at = found.sel(bow_force=0.5, bow_position=0.256, method="nearest")
    assert float(at.pitch_hz) == swept.grid("pitch_hz")[1, 1]
    assert found.bow_position.attrs["units"] == "m"
    assert found.regime.attrs["flag_meanings"].split()[2] == "helmholtz"
    assert found.attrs["source"] == f"yehu-server {yehu.__version__}"
    assert found.attrs["sample_rate"] == 44100.0
    assert json.loads(found.attrs["instrument"])["bow"]["mu_S"] == 1.0207
    assert repr(swept) == "<yehu_server.Sweep of 6 strokes over bow_force (2), bow_position (3)>"
    swept.save(str(tmp_path / "found.npz"))
    assert yehu.Sweep.load(str(tmp_path / "found.npz")).to_xarray().attrs == found.attrs
    vary = {"instrument.bow.K_h": [1e4, 5e4], "bow_acceleration": [1.0]}
    gesture = {"duration": 0.06, "controls": {"bow_velocity": 0.2, "bow_force": 0.5}}
    other = yehu.sweep(gesture, vary).to_xarray()
    units = {name: other[name].attrs["units"] for name in vary}
    assert units == {"instrument.bow.K_h": "N/m", "bow_acceleration": "m s-2"}


def test_without_xarray_one_line_says_what_to_install(swept, monkeypatch, refused):
    monkeypatch.setitem(sys.modules, "xarray", None)
    refused("yehu-server[lab]", swept[0].to_xarray)


def test_wrong_values_are_reported_in_one_line(refused):
    many = {"bow_force": np.linspace(0, 1, 1001), "press_force": np.linspace(0, 1, 1000)}
    for vary, names in (
        ({}, "vary"),
        ([1.0], "vary"),
        *(({"bow_force": wrong}, "bow_force") for wrong in (0.5, [], [0.1, "b"], [1e9])),
        ({"no.such": [1.0]}, "no"),
        ({7: [1.0]}, "7"),
        ({"bow_acceleration": [1.0]}, "bow_velocity"),
        (many, "runs"),
    ):
        refused(names, yehu.sweep, {"duration": 0.05}, vary)
