"""What the laboratory reads: taps on bodies, studies and their results, descriptions of data."""

import json
import math
import re

import numpy as np
import scipy.optimize  # noqa: F401 - which takes a second, of no input
from fuzz.target import target, written

from yehu_lab.body.body_file import read_fit
from yehu_lab.body.curve import Curve
from yehu_lab.body.measurement import read
from yehu_lab.dataset.description import read_description
from yehu_lab.sweeps.result import Result
from yehu_lab.sweeps.study import read_study, study_from_text
from yehu_server.errors import MeasurementError, ParameterError, ScoreError

SHIPPED_RATE = re.compile(rb"^sample_rate *= *(44100|48000) *$", re.MULTILINE)
CHANNELS = "force=100,velocity=0.5"


def check_curve(curve: Curve | None) -> None:
    """Frequencies rise, and all is finite."""
    if curve is None:
        return
    assert np.all(np.diff(curve.frequency_hz) > 0.0)
    assert np.isfinite(curve.frequency_hz).all()
    assert np.isfinite(curve.values).all()
    assert curve.coherence is None or np.isfinite(curve.coherence).all()


def measure(data: bytes, name: str, channels: str | None = None) -> None:
    measured = read([written(data, name)], channels=channels)
    assert measured.admittance is not None or measured.radiation is not None
    check_curve(measured.admittance)
    check_curve(measured.radiation)
    assert all(line.isprintable() for line in measured.warnings)


@target(
    "measured-table",
    MeasurementError,
    words=(b"frequency_hz,", b"time_s,", b"force_N,", b"velocity_mm/s,", b"mobility", b"real,",
           b"imag", b"magnitude_dB,", b"phase_deg", b"coherence", b"\n100,", b"1e308", b"nan",
           b";", b"\t", b"0.5,-0.5\n"),
)  # fmt: skip
def measured_table(data: bytes) -> None:
    """A table gives finite curves over rising frequencies, or a MeasurementError."""
    measure(data, "measured.csv")


@target(
    "measured-universal",
    MeasurementError,
    words=(b"    -1\n", b"    58\n", b"   164\n", b"    58b", b"         4", b"        11",
           b"         0", b"  0.00000e+00", b"  1.00000e+00", b" -1.00000e+308", b"NONE"),
)  # fmt: skip
def measured_universal(data: bytes) -> None:
    """A universal file gives finite curves over rising frequencies, or a MeasurementError."""
    measure(data, "measured.uff")


@target(
    "measured-sound",
    MeasurementError,
    words=(b"RIFF", b"WAVE", b"fmt ", b"data", b"\x44\xac\0\0", b"\x02\0", b"\xff\x7f"),
)
def measured_sound(data: bytes) -> None:
    """A sound file of taps gives finite curves, or a MeasurementError."""
    measure(data, "measured.wav", CHANNELS)


@target(
    "fitted-body",
    MeasurementError,
    ParameterError,
    words=(b'"fit": {', b'"measured": {', b'"warnings": []', b'"admittance": {', b'"real": [',
           b'"frequency_hz": [', b'"band_hz": [100, 8000]', b"1e308", b"null", b"[1, 2]"),
    also=("yehu_server/core/physics/body.json",),
)  # fmt: skip
def fitted_body(data: bytes) -> None:
    """A body file gives a fit of finite curves, or is refused."""
    found = read_fit(written(data, "fitted.json"))
    low, high = found.band_hz
    assert 0.0 < low < high < math.inf
    check_curve(found.measurement.admittance)
    check_curve(found.measurement.radiation)
    assert np.isfinite(found.admittance(np.array([low, high]))).all()


@target(
    "study",
    ScoreError,
    ParameterError,
    words=(b"[stroke]\n", b"[vary]\n", b"[refine]\n", b"[gesture.controls]\n", b"note = [65, 66]\n",
           b'force = { from = 0.03, to = 6.0, steps = 45, spread = "log" }\n', b"levels = 2\n",
           b'axes = ["force"]\n', b"string = 2\n", b"duration = 0.3\n", b"nan", b"1e308", b"-1",
           b'border = "helmholtz"\n', b'"instrument.bow.mu_S" = [1.0]\n'),
    also=("examples/studies/*.toml",),
)  # fmt: skip
def study(data: bytes) -> None:
    """A study has axes of finite values, and reads the same again from its text, or is refused."""
    if b"sample_rate" in data and not SHIPPED_RATE.search(data):
        return  # the instrument is calibrated first, which takes seconds
    found = read_study(written(data, "study.toml"))
    assert found.axes
    assert 1 <= found.coarse <= math.prod(found.shape)
    for axis in found.axes:
        assert all(isinstance(value, str) or math.isfinite(value) for value in axis.values)
    again = study_from_text(found.as_text())
    assert (again.axes, again.refine, again.levels) == (found.axes, found.refine, found.levels)


@target(
    "sweep-result",
    ScoreError,
    words=(b"PK\x03\x04", b"PK\x01\x02", b"PK\x05\x06", b"\x93NUMPY\x01\0", b"meta.npy",
           b"numbers.npy", b"'descr': '<i8'", b"'shape': (9999999999,)", b'"format":'),
)  # fmt: skip
def sweep_result(data: bytes) -> None:
    """A result has a finding for each of its strokes, on its grid, or a ScoreError."""
    found = Result.load(written(data, "result.npz"))
    assert 1 <= len(found) <= math.prod(found.shape)
    assert all(len(column) == len(found) for column in found.columns.values())
    assert found.index.shape == (len(found), len(found.axes))


@target(
    "dataset",
    ParameterError,
    words=(b'kind = "strokes"\n', b'kind = "notes"\n', b"count = 10\n", b"seed = 7\n", b"[draw]\n",
           b"[split]\n", b"train = 0.8\n", b"bow_force = [0.1, 1.0]\n", b"bow_position = 0.12\n",
           b'{ from = 0.1, to = 1.0, spread = "log" }', b'keep = ["bridge_force"]\n', b"nan",
           b"1e308", b"[instrument]\n"),
    also=("examples/dataset.toml",),
)  # fmt: skip
def dataset(data: bytes) -> None:
    """A description draws finite values for each sound, or is refused."""
    found = read_description(written(data, "dataset.toml"))
    for number in (0, found.count - 1):
        drawn = found.drawn(number)
        assert all(math.isfinite(value) for value in drawn.values())
        assert found.drawn(number) == drawn
        assert found.split(number)
        json.dumps(drawn, allow_nan=False)
