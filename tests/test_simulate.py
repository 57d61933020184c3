"""``yehu-server simulate``: gestures in physical units to arrays, read back."""

import json
import math
from pathlib import Path

import numpy as np
import pytest
import scipy

from yehu_server.cli import main
from yehu_server.errors import OutputError, ParameterError
from yehu_server.scores.gesture import gesture_from
from yehu_server.simulation.run import simulate

BODY = Path(__file__).resolve().parents[1] / "yehu_server" / "core" / "physics" / "body.json"
GESTURE = {
    "sample_rate": 44100,
    "duration": 2.0,
    "instrument": {"bow": {"epsilon_0": 31860.0}},
    "controls": {
        "bow_force": [[0, 0.0], [0.02, 0.7]],
        "bow_velocity": [[0, 0.0], [0.03, 0.3]],
        "bow_position": [[0, 0.255]],
        "finger_position": [[0, 0.1]],
        "press_force": [[0, 0.0], [1.0, 0.5]],
    },
    "pluck": {"string": 1, "position": 0.1, "amplitude": 0.001},
    "hammer": [[0.0, 0.0], [0.0005, 5.0], [0.001, 0.0]],
}
SCALARS = (
    "bridge_force",
    "bridge_force_1",
    "bridge_force_2",
    "bridge_velocity",
    "pressure",
    "finger_displacement",
    "friction_force",
    "relative_velocity",
    "iterations",
    "time",
)
LOSSES = (
    "loss_strings",
    "loss_bridge",
    "loss_finger",
    "loss_hair",
    "loss_friction",
    "loss_bow_lift",
    "loss_contact_reset",
)
PLUCK = {"string": 1, "position": 0.1, "amplitude": 0.001}


def run(gesture: dict, **options) -> dict:
    return dict(simulate(gesture_from(gesture), **options).arrays)


@pytest.fixture(scope="module")
def kept(tmp_path_factory) -> dict:
    """The arrays that the command writes for GESTURE."""
    folder = tmp_path_factory.mktemp("simulate")
    (folder / "gesture.json").write_text(json.dumps(GESTURE))
    words = [str(folder / "gesture.json"), "-o", str(folder / "run.npz")]
    assert main(["simulate", *words, "--energy", "--strings", "100", "--quiet"]) == 0
    assert {path.name for path in folder.iterdir()} == {"gesture.json", "run.npz"}
    with np.load(folder / "run.npz", allow_pickle=False) as file:
        return dict(file)


# ---------------------------------------------------------------- what is kept


def test_every_promised_signal_has_one_finite_value_a_sample(kept):
    for name in SCALARS:
        assert kept[name].shape == (88200,), name
        assert np.isfinite(kept[name]).all(), name
        assert kept[name].any(), name
    assert kept["contact_force"].shape == (88200, 2)
    assert kept["contact_force"].any(axis=0).all()
    assert np.issubdtype(kept["iterations"].dtype, np.integer)
    np.testing.assert_allclose(kept["time"], np.arange(88200) / 44100, rtol=0, atol=1e-12)
    both = kept["bridge_force_1"] + kept["bridge_force_2"]
    np.testing.assert_allclose(kept["bridge_force"], both, rtol=0, atol=1e-12)


def test_pressure_is_the_bridge_force_through_the_measured_filter(kept):
    radiation = json.loads(BODY.read_text())["radiation"]
    force = kept["bridge_force"]
    expected = radiation["direct_gain"] * force
    for b0, b1, a1, a2 in radiation["sections"]:
        expected = expected + scipy.signal.lfilter([b0, b1], [1.0, a1, a2], force)
    scale = np.abs(expected).max()
    np.testing.assert_allclose(kept["pressure"], expected, rtol=0, atol=1e-9 * scale)


def test_the_meta_data_tell_what_was_run(kept):
    meta = json.loads(str(kept["meta"]))
    assert meta["sample_rate"] == 44100
    assert meta["frames"] == 88200
    assert meta["bridge_x_m"] == 0.30
    assert meta["unconverged_solves"] == 0
    assert meta["lost_states"] == 0
    assert meta["version"]
    assert len(meta["grid_intervals"]) == len(meta["grid_spacing_m"]) == 2
    for intervals, spacing in zip(meta["grid_intervals"], meta["grid_spacing_m"], strict=True):
        assert intervals * spacing == pytest.approx(0.38)


def test_the_energy_ledger_is_kept_and_closes(kept):
    for name in ("energy", "power_in", "energy_error", *LOSSES):
        assert kept[name].shape == (88200,), name
        assert np.isfinite(kept[name]).all(), name
    assert (kept["energy"] >= 0.0).all()
    flow = np.abs(kept["power_in"]).max()
    assert flow > 0.01
    assert np.abs(kept["energy_error"]).max() <= 1e-9 * flow
    # The error is what the other columns leave: dE/dt - power in + losses.
    change = np.diff(kept["energy"]) * 44100
    lost = sum(kept[name][1:] for name in LOSSES)
    left = change - kept["power_in"][1:] + lost
    assert np.abs(left).max() <= 1e-9 * flow


# ---------------------------------------------------------------- controls


def test_controls_are_straight_between_their_points_and_constant_outside():
    arrays = run(
        {
            "sample_rate": 44100,
            "duration": 0.01,
            "controls": {
                "bow_force": [[0.001, 0.2], [0.003, 0.6], [0.004, -0.1]],
                "bow_velocity": 0.25,
                "press_force": [[0.002, 0.0], [0.002, 0.5]],
            },
        }
    )
    force = arrays["bow_force"]
    times = arrays["time"]
    for n, time in enumerate(times):
        if time <= 0.001:
            expected = 0.2
        elif time <= 0.003:
            expected = 0.2 + 0.4 * (time - 0.001) / 0.002
        elif time <= 0.004:
            expected = 0.6 - 0.7 * (time - 0.003) / 0.001
        else:
            expected = -0.1
        assert force[n] == pytest.approx(expected, abs=1e-12)
    assert (arrays["bow_velocity"] == 0.25).all()
    assert (arrays["press_force"] == np.where(times < 0.002, 0.0, 0.5)).all()
    assert (arrays["bow_position"] == 0.255).all()  # the usual values
    # A finger waits over the bridge until it presses.
    assert (arrays["finger_position"] == np.where(times < 0.002, 0.3, 0.1)).all()


# ---------------------------------------------------------------- pluck and hammer


STRONG = {"bow_force": [[0, 0.0], [0.02, 2.5]], "bow_velocity": [[0, 0.0], [0.02, 0.9]]}


def test_a_finger_waits_over_the_bridge_but_while_it_presses_and_is_lifted():
    press = [[0, 0.0], [0.1, 0.0], [0.1, 1.5], [0.2, 1.5], [0.2, 0.0]]
    arrays = run({"duration": 0.4, "controls": STRONG | {"press_force": press}})
    time, touched = arrays["time"], arrays["contact_force"].any(axis=1)
    assert not touched[time < 0.1].any()
    assert touched[(time > 0.12) & (time < 0.2)].mean() > 0.9
    waits = arrays["finger_position"] == 0.3
    assert not touched[waits].any()
    np.testing.assert_array_equal(waits, (time < 0.1) | (time > 0.23997))


def test_a_plucked_string_starts_as_a_triangle_at_rest_up_to_the_bridge():
    arrays = run({"duration": 0.001, "pluck": PLUCK}, strings_every=1)
    x, shape = arrays["x_1"], arrays["string_1"][0]
    triangle = np.interp(x, [0.0, 0.1, 0.3], [0.0, 0.001, 0.0])
    away = (x < 0.27) | (x > 0.33)  # but for what ties it to the bridge
    np.testing.assert_allclose(shape[away], triangle[away], rtol=0, atol=1e-12)
    assert not arrays["string_2"][0].any()
    np.testing.assert_allclose(arrays["string_1"][1], shape, rtol=0, atol=2e-4)


def test_a_string_in_two_directions_starts_turned_from_the_bow_by_the_angle_of_its_pluck():
    gesture = {
        "duration": 0.02,
        "instrument": {"directions": "two"},
        "pluck": PLUCK | {"angle": 60.0},
    }
    found = simulate(gesture_from(gesture), energy=True, strings_every=8)
    arrays, turned = found.arrays, math.tan(math.radians(60.0))
    np.testing.assert_allclose(arrays["string_1_normal"][0], turned * arrays["string_1"][0])
    assert not arrays["string_2_normal"][0].any()
    assert np.abs(arrays["string_2_normal"][-1]).max() > 0.0  # by the bridge
    assert np.abs(arrays["energy_error"]).max() < 1e-10
    assert found.meta["instrument"]["directions"] == "two"
    with pytest.raises(ParameterError, match='angle: needs an instrument with directions = "two"'):
        gesture_from({"pluck": PLUCK | {"angle": 60.0}})


def test_a_hammer_is_lifted_before_and_after_its_curve():
    one = run({"duration": 0.05, "hammer": [[0.001, 5.0], [0.002, 5.0]]})["bridge_velocity"]
    curve = [[0.001, 0.0], [0.001, 5.0], [0.002, 5.0], [0.002, 0.0]]
    other = run({"duration": 0.05, "hammer": curve})["bridge_velocity"]
    assert not one[:40].any()
    np.testing.assert_allclose(one, other, rtol=0, atol=0.05 * np.abs(other).max())


# ---------------------------------------------------------------- what is refused


def control(name: str, value: object) -> dict:
    return {"controls": {name: value}}


def test_a_gesture_that_makes_no_sense_is_refused_by_name(subtests):
    for gesture, wrong in [
        ([], "gesture"),
        ({"rate": 44100}, "rate: unknown entry"),
        ({"sample_rate": 22049}, "sample_rate"),
        ({"sample_rate": math.nan}, "sample_rate"),
        ({"duration": 1e-6}, "duration"),
        ({"duration": 3601}, "duration"),
        ({"instrument": []}, "instrument"),
        ({"instrument": {"bows": {}}}, "bows: unknown entry"),
        ({"instrument": {"body": "/no/such/body.json"}}, "body"),
        ({"controls": []}, "controls"),
        (control("bow_pressure", 0.5), "bow_pressure: unknown entry"),
        (control("bow_force", [[0, math.inf]]), "bow_force"),
        (control("bow_force", [[0, 0.5], [0.2, 0.6], [0.1, 0.7]]), "bow_force"),
        (control("bow_force", 51), "bow_force"),
        (control("bow_force", []), "bow_force"),
        (control("bow_force", [[0, 1, 2]]), "bow_force"),
        (control("bow_force", None), "bow_force"),
        (control("bow_position", 0.0), "bow_position"),
        (control("bow_position", 0.31), "bow_position"),
        (control("finger_position", 0.39), "finger_position"),
        (control("press_force", -0.1), "press_force"),
        ({"pluck": 3}, "pluck"),
        ({"pluck": {"string": 1.5}}, "pluck.string"),
        ({"pluck": {"strings": 1}}, "strings: unknown entry"),
        ({"pluck": {"position": 0.3}}, "pluck.position"),
        ({"pluck": {"amplitude": 1.0}}, "pluck.amplitude"),
        ({"hammer": "hard"}, "hammer"),
        ({"hammer": [[0, 1e5]]}, "hammer"),
    ]:
        with subtests.test(gesture=gesture, wrong=wrong):
            with pytest.raises(ParameterError) as caught:
                gesture_from(gesture)
            assert wrong in str(caught.value)
            assert str(caught.value).isprintable()


def test_what_would_not_fit_into_memory_is_refused_before_it_runs():
    with pytest.raises(OutputError, match="GiB"):
        simulate(gesture_from({"duration": 3600, "sample_rate": 192000}))


def test_a_rocking_finger_swings_pitch_and_level_in_both_directions():
    controls = {"finger_position": 0.1, "press_force": [[0.0, 0.0], [0.05, 2.0]]}
    controls["pluck_position"], controls["pluck_force"] = 0.22, [[0.1, 1.0], [0.15, 1.0], [0.15, 0]]
    rocking = {"rate": 8.0, "reach": 0.002, "lean": 0.5, "start": 0.1}
    data = {"duration": 0.4, "instrument": {"directions": "two"}, "controls": controls}
    run = simulate(gesture_from({**data, "rocking": rocking}), energy=True)
    time, place = run.arrays["time"], run.arrays["finger_position"]
    turn = np.where(time > 0.1, np.sin(2.0 * np.pi * 8.0 * (time - 0.1)), 0.0)
    np.testing.assert_allclose(place[1:], 0.1 + 0.002 * turn[1:], atol=2e-5)
    late = time > 0.1
    press = run.arrays["press_force"]
    np.testing.assert_allclose(press[late], 2.0 + turn[late], atol=2e-2)
    assert np.abs(run.arrays["energy_error"]).max() < 1e-9 * run.arrays["power_in"].max()
    with pytest.raises(ParameterError, match="rocking: takes the finger beyond the loop or the br"):
        gesture_from({**data, "rocking": {"reach": 0.02}, "controls": {"finger_position": 0.29}})
    with pytest.raises(ParameterError, match=r"rocking\.reach"):
        gesture_from({**data, "rocking": {"reach": 1.0}})
