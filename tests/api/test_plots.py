"""``yehu.plot``: what its pictures show."""

import importlib
import sys
import types

import matplotlib as mpl
import numpy as np
import pytest

import yehu_server as yehu
from yehu_lab.regimes.columns import FINDING, HELMHOLTZ
from yehu_lab.sweeps.result import Result, result_of
from yehu_lab.sweeps.study import study_of

RATE = 44100
BOWED = {"bow_force": [[0, 0], [0.03, 0.7]], "bow_velocity": [[0, 0], [0.03, 0.3]]}


@pytest.fixture(autouse=True)
def plt() -> types.ModuleType:
    """``matplotlib.pyplot``, which takes long to load."""
    mpl.use("Agg")
    return importlib.import_module("matplotlib.pyplot")


def sine(hz: float, seconds: float = 0.5) -> np.ndarray:
    return 0.1 * np.sin(2.0 * np.pi * hz * np.arange(round(seconds * RATE)) / RATE)


def result(axes: dict, controls: dict | None = None, **columns) -> Result:
    """The result of a sweep, with these columns on its grid and nothing in others."""
    gesture = {"duration": 0.1, "controls": {"bow_velocity": 0.2} | (controls or {})}
    vary = {name: list(map(float, values)) for name, values in axes.items()}
    study = study_of({"gesture": gesture, "vary": vary})
    findings = np.zeros(int(np.prod(study.shape)), FINDING)
    for name, grid in columns.items():
        findings[name] = np.ravel(grid)
    return result_of(study, np.arange(len(findings)), findings)


def labels(axes) -> list[str]:
    return [text.get_text() for text in axes.get_legend().get_texts()]


def line(axes, label: str):
    return next(each for each in axes.get_lines() if each.get_label() == label)


def test_a_new_figure_has_room_for_the_legend_of_a_map():
    found = result({"bow_force": [0.1, 1.0], "bow_velocity": [0.1, 0.2]}, regime=HELMHOLTZ)
    axes = yehu.plot.regimes(found, "bow_force", "bow_velocity")
    axes.figure.canvas.draw()
    assert axes.get_legend().get_window_extent().x1 <= axes.figure.bbox.x1


# ---------------------------------------------------------------- sounds


def test_a_spectrogram_is_brightest_at_the_sine_and_has_its_pitch_over_it(plt):
    assert not yehu.plot.spectrogram(sine(500.0), RATE, pitch=False).get_lines()
    plt.figure()
    axes = yehu.plot.spectrogram(sine(1000.0), RATE, top_hz=4000.0)
    (image,) = axes.get_images()
    left, right, bottom, top = image.get_extent()
    spectrum = image.get_array()
    row = spectrum[:, spectrum.shape[1] // 2].argmax()
    khz = bottom + (row + 0.5) * (top - bottom) / len(spectrum)
    assert khz == pytest.approx(1.0, abs=0.02)
    assert (left, right) == (pytest.approx(0.0, abs=0.01), pytest.approx(0.5, abs=0.02))
    heard = line(axes, "pitch").get_ydata()
    assert np.nanmedian(heard) == pytest.approx(1.0, abs=0.002)
    assert axes.get_ylim() == (0.0, 4.0)


# ---------------------------------------------------------------- runs


@pytest.fixture(scope="module")
def run() -> yehu.Simulation:
    controls = BOWED | {"press_force": [[0, 0], [0.1, 0], [0.11, 1.0]]}
    gesture = {"duration": 0.2, "controls": controls}
    return yehu.simulate(gesture, energy=True, strings_every=20)


def test_strings_are_drawn_where_they_are(run, plt):
    before = yehu.plot.strings(run, 0.05).get_lines()  # with the finger lifted
    assert {"finger", "bow"} & {each.get_label() for each in before} == {"bow"}
    plt.figure()
    axes = yehu.plot.strings(run, 0.15)
    row = int(np.abs(run.arrays["strings_time"] - 0.15).argmin())
    inner = line(axes, "inner string")
    np.testing.assert_allclose(inner.get_ydata(), 1e3 * run.arrays["string_1"][row])
    np.testing.assert_allclose(inner.get_xdata(), run.arrays["x_1"])
    assert line(axes, "finger").get_xdata() == pytest.approx([0.1])
    assert line(axes, "bow").get_xdata()[0] == pytest.approx(0.255)
    assert line(axes, "bridge").get_xdata() == pytest.approx([0.3])


def test_strings_of_an_instrument_have_all_fingers_that_are_down():
    fiddle = yehu.Instrument()
    controls = {"/finger/1/position": 0.05, "/finger/2/position": 0.1}
    controls |= {"/finger/1/press": 1.5, "/finger/2/press": 1.5}
    played = fiddle.record(0.1, controls=controls, strings_every=100)
    axes = yehu.plot.strings(played, 0.09)
    assert line(axes, "finger").get_xdata() == pytest.approx([0.05, 0.1])


def test_the_stack_of_energies_ends_at_what_was_given():
    run = yehu.simulate({"duration": 0.2, "controls": BOWED}, energy=True)
    axes = yehu.plot.energy(run)
    given = line(axes, "given").get_ydata()
    top = axes.collections[-1].get_paths()[0].vertices[:, 1].max()
    assert top == pytest.approx(given.max(), rel=2e-3)
    # By another way: force times speed of the bow, in mJ.
    arrays = run.arrays
    worked = 1e3 * np.sum(arrays["friction_force"] * arrays["bow_velocity"]) / RATE
    assert given[-1] == pytest.approx(abs(worked), rel=0.02)
    assert "W missing" in axes.get_title("left")


# ---------------------------------------------------------------- maps


def test_regimes_are_drawn_where_they_were_found(plt):
    grid = np.array([[0, 1], [1, 1], [6, 2]])
    found = result({"bow_force": [0.1, 0.2, 0.3], "bow_velocity": [0.1, 0.2]}, regime=grid)
    axes = yehu.plot.regimes(found, "bow_velocity", "bow_force")
    (mesh,) = axes.collections
    np.testing.assert_array_equal(mesh.get_array().reshape(3, 2), grid)
    assert labels(axes) == ["unbowed", "silent", "helmholtz", "raucous"]
    assert axes.get_title() == "Helmholtz: 16.7 % ± 3.3 by the sample rate"
    assert axes.get_xlim() == pytest.approx((0.05, 0.25))
    plt.figure()
    turned = yehu.plot.regimes(found, "bow_force", "bow_velocity")
    np.testing.assert_array_equal(turned.collections[0].get_array().reshape(2, 3), grid.T)
    plt.figure()
    shuffled = {"bow_force": [0.3, 0.1, 0.2], "bow_velocity": [0.2, 0.1]}
    found = result(shuffled, regime=grid[[2, 0, 1], ::-1])
    (mesh,) = yehu.plot.regimes(found, "bow_velocity", "bow_force").collections
    np.testing.assert_array_equal(mesh.get_array().reshape(3, 2), grid)
    assert mesh.get_coordinates()[0, :, 0].tolist() == pytest.approx([0.05, 0.15, 0.25])


def test_schellengs_limits_are_his_closed_forms():
    beta = np.geomspace(0.05, 0.3, 5)
    forces = np.geomspace(0.05, 3.0, 4)
    found = result(
        {"bow_position": 0.3 - 0.3 * beta, "bow_force": forces}, regime=np.ones((5, 4), int)
    )
    axes = yehu.plot.schelleng(found)
    upper = line(axes, "Schelleng's upper limit")
    # [Schelleng]: 2 Z v / (beta (mu_S - mu_C)), of the inner string of table 1, at 0.2 m/s.
    impedance = np.sqrt(50.61 * 1250.0 * np.pi) * 0.55e-3
    expected = 2.0 * impedance * 0.2 / ((1.0207 - 0.5071) * upper.get_xdata())
    np.testing.assert_allclose(upper.get_ydata(), expected, rtol=1e-6)
    lower = line(axes, "Schelleng's lower limit").get_ydata()
    np.testing.assert_allclose(lower * upper.get_xdata() ** 2, lower[0] * upper.get_xdata()[0] ** 2)
    assert (axes.get_xscale(), axes.get_yscale()) == ("log", "log")
    assert labels(axes)[-2:] == ["Schelleng's upper limit", "Schelleng's lower limit"]


def test_guettler_counts_periods_from_the_first_slip_and_leaves_out_what_never_came():
    found = result(
        {"bow_acceleration": [1.0, 2.0], "bow_force": [0.1, 0.2]},
        helmholtz_s=[[0.03, np.nan], [0.11, 0.06]],
        first_slip_s=0.01,
        pitch_hz=[[500.0, 500.0], [500.0, 400.0]],
        regime=[[HELMHOLTZ, HELMHOLTZ], [0, HELMHOLTZ]],  # one has left it again
    )
    axes = yehu.plot.guettler(found)
    cells = axes.collections[0].get_array().reshape(2, 2)
    assert cells.mask.tolist() == [[False, True], [True, False]]
    assert cells.compressed().tolist() == pytest.approx([10.0, 20.0])


def test_a_sweep_is_drawn_as_the_map_that_its_axes_are_for(plt):
    for other, values, label in (
        ("bow_velocity", [0.1, 0.2], "bow speed, m/s"),
        ("bow_position", [0.25, 0.26], "bow position β"),
        ("bow_acceleration", [1.0, 2.0], "acceleration of the bow, m/s²"),
    ):
        plt.figure()
        axes = yehu.plot.sweep(result({"bow_force": [0.1, 0.2], other: values}))
        assert axes.get_xlabel() == label


# ---------------------------------------------------------------- axes in, axes out


def test_what_cannot_be_drawn_is_reported_in_one_line(run, monkeypatch, refused):
    found = result({"bow_force": [0.1, 0.2], "bow_velocity": [0.1, 0.2]}, regime=[[1, 1]] * 2)
    plot, some = yehu.plot, np.zeros(99)
    refused("sample_rate", plot.spectrogram, some)
    refused("top_hz", plot.spectrogram, some, RATE, top_hz=1e6)
    refused("sound", plot.level, "a.wav")
    refused("ax", plot.level, some, RATE, ax=7)
    refused("of shape (frames, 2), not (2, 9)", plot.spectrogram, np.zeros((2, 9)), RATE)
    for wrong in (np.zeros(0), np.array([0.0, np.nan])):
        refused("expected samples, all of them finite", plot.pitch, wrong, RATE)
    brief = yehu.simulate({"duration": 0.01, "controls": BOWED})
    refused("start, end: nothing is there; it lasts 0.009977 s", plot.signals, brief, start=5)
    refused("strings_every", plot.strings, np.zeros(3), 0.0)
    refused("energy=True", plot.energy, object())
    refused("'x'", plot.regimes, found, "bow_force", "x")
    refused("two axes", plot.regimes, found, "bow_force", "bow_force")
    refused("'z'", plot.regimes, found, "bow_force", "bow_velocity", at={"z": 1.0})
    refused("bow_position", plot.schelleng, found)
    refused("bow_acceleration", plot.guettler, found)
    for time in (9.0, "end"):  # not within the run
        refused("time", plot.strings, run, time)
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    refused("yehu-server[plots]", plot.energy, run)
    refused("yehu-server[plots]", plot.level, some, RATE)
