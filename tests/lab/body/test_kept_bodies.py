"""Body files: written, played, and read again with what was measured."""

import json
import math
import tomllib
from dataclasses import replace

import numpy as np
import pytest
from lab.body.bodies import off_db, rms

from yehu_server.core.physics.quantities import read_body, read_quantities
from yehu_server.errors import MeasurementError, OutputError, ParameterError
from yehu_server.lab.body.body_file import read_fit
from yehu_server.util.files import MAX_SETTINGS_BYTES

GRID = np.geomspace(150.0, 5000.0, 2000)


def test_an_instrument_file_plays_the_fitted_body(whole_fit, tmp_path):
    written = whole_fit.save(tmp_path / "mine.toml")
    assert [path.name for path in written] == ["mine.toml", "mine.body.json"]
    assert read_quantities(tmp_path / "mine.toml").body == whole_fit.body


def test_a_body_file_alone_is_written(whole_fit, tmp_path):
    assert whole_fit.save(tmp_path / "mine.json") == (tmp_path / "mine.json",)
    assert read_body(tmp_path / "mine.json") == whole_fit.body
    assert (tmp_path / "mine.json").stat().st_size < MAX_SETTINGS_BYTES / 2


@pytest.mark.parametrize("name", ["mine.toml", "mine.json"])
def test_what_was_measured_is_kept(whole_fit, tmp_path, name):
    whole_fit.save(tmp_path / name)
    again = read_fit(tmp_path / name)
    assert again.body == whole_fit.body
    assert again.warnings == whole_fit.warnings
    assert again.admittance_db == whole_fit.admittance_db
    assert again.radiation_db == whole_fit.radiation_db
    assert again.band_hz == whole_fit.band_hz
    kept = again.measurement.admittance
    assert kept.taps == 5
    assert rms(off_db(kept.values, whole_fit.admittance(kept.frequency_hz))) < 0.6
    assert len(kept.values) < 1200


def test_the_same_fit_gives_the_same_file(whole_fit, tmp_path):
    whole_fit.save(tmp_path / "one.json")
    whole_fit.save(tmp_path / "two.json")
    assert (tmp_path / "one.json").read_bytes() == (tmp_path / "two.json").read_bytes()


def test_fitting_again_keeps_what_was_added_to_the_instrument(whole_fit, tmp_path):
    target = tmp_path / "mine.toml"
    whole_fit.save(target)
    target.write_text(target.read_text() + "[string_1]\nT = 52.0\n")
    fewer = replace(whole_fit, warnings=("another",))
    assert fewer.save(target) == (tmp_path / "mine.body.json",)
    assert tomllib.loads(target.read_text())["string_1"] == {"T": 52.0}
    assert read_fit(target).warnings == ("another",)


@pytest.mark.parametrize("name", ["mine.toml", "mine.body.json"])
def test_other_files_are_not_replaced(whole_fit, tmp_path, name):
    (tmp_path / name).write_text("bridge_x = 0.31\n")
    with pytest.raises(OutputError, match="--overwrite"):
        whole_fit.save(tmp_path / "mine.toml")
    assert [path.name for path in tmp_path.iterdir()] == [name]
    assert (tmp_path / name).read_text() == "bridge_x = 0.31\n"
    whole_fit.save(tmp_path / "mine.toml", overwrite=True)
    assert read_quantities(tmp_path / "mine.toml").body == whole_fit.body


@pytest.mark.parametrize("name", ["mine.wav", "mine", "missing/mine.toml"])
def test_other_names_are_refused(whole_fit, tmp_path, name):
    with pytest.raises(OutputError):
        whole_fit.save(tmp_path / name)
    assert not list(tmp_path.iterdir())


def test_the_shipped_body_can_be_looked_at():
    from yehu_server.core.physics.quantities import BODY_FILE, measured_body

    found = read_fit(BODY_FILE)
    assert found.body == measured_body()
    assert found.measurement.admittance is None


def damaged(data, where, value):
    entry = data
    for key in where[:-1]:
        entry = entry[key]
    entry[where[-1]] = value
    return data


@pytest.mark.parametrize(
    ("where", "value"),
    [
        (("measured", "admittance", "real"), [1.0]),
        (("measured", "admittance", "frequency_hz"), None),
        (("measured",), 7),
        (("fit", "band_hz"), [1.0]),
        (("fit", "warnings"), None),
        (("fit", "admittance_db"), {"rms": "x"}),
    ],
)
def test_damaged_measurements_are_told(whole_fit, tmp_path, where, value):
    whole_fit.save(tmp_path / "mine.json")
    data = json.loads((tmp_path / "mine.json").read_text())
    (tmp_path / "mine.json").write_text(json.dumps(damaged(data, where, value)))
    with pytest.raises(MeasurementError, match=r"mine\.json"):
        read_fit(tmp_path / "mine.json")


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (lambda column: column[::-1], "do not rise"),
        (lambda column: [0.0, *column[1:]], "do not rise"),
        (lambda column: [*column[:-1], column[-2]], "do not rise"),
        (lambda column: [*column[:-1], math.inf], "not finite"),
    ],
)
def test_frequencies_that_no_measurement_has_are_told(whole_fit, tmp_path, change, told):
    whole_fit.save(tmp_path / "mine.json")
    data = json.loads((tmp_path / "mine.json").read_text())
    curve = data["measured"]["admittance"]
    curve["frequency_hz"] = change(curve["frequency_hz"])
    (tmp_path / "mine.json").write_text(json.dumps(data))
    with pytest.raises(MeasurementError, match=told):
        read_fit(tmp_path / "mine.json")


@pytest.mark.parametrize("text", ["", "{}", "[1]", '{"bridge_modes": 1}', "x"])
def test_what_is_no_body_is_told(tmp_path, text):
    (tmp_path / "x.json").write_text(text)
    with pytest.raises((MeasurementError, ParameterError), match=r"x\.json"):
        read_fit(tmp_path / "x.json")
