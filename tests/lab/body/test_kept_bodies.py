"""Body files: written, played, and read again with what was measured."""

import json
import math
import tomllib
from dataclasses import replace
from pathlib import Path

import pytest
from lab.body.bodies import off_db, rms

from yehu_lab.body.body_file import read_fit
from yehu_server.core.physics.default_quantities import read_body, read_quantities
from yehu_server.errors import MeasurementError, OutputError, ParameterError
from yehu_server.util.files import MAX_SETTINGS_BYTES

ROOT = Path(__file__).resolve().parents[3]


def test_an_instrument_or_a_body_file_plays_the_fitted_body_and_keeps_what_was_measured(
    whole_fit, tmp_path
):
    for name, written in (
        ("mine.toml", ["mine.toml", "mine.body.json"]),
        ("alone.json", ["alone.json"]),
    ):
        target = tmp_path / name
        assert [path.name for path in whole_fit.save(target)] == written
        assert (tmp_path / written[-1]).stat().st_size < MAX_SETTINGS_BYTES / 2
        again = read_fit(target)
        assert again.body == whole_fit.body
        assert again.warnings == whole_fit.warnings
        assert again.admittance_db == whole_fit.admittance_db
        assert again.radiation_db == whole_fit.radiation_db
        assert again.band_hz == whole_fit.band_hz
        kept = again.measurement.admittance
        assert kept.taps == 5
        assert rms(off_db(kept.values, whole_fit.admittance(kept.frequency_hz))) < 0.6
        assert len(kept.values) < 1200
    assert read_quantities(tmp_path / "mine.toml").body == whole_fit.body
    assert read_body(tmp_path / "alone.json") == whole_fit.body
    one, other = (tmp_path / name for name in ("mine.body.json", "alone.json"))
    assert one.read_bytes() == other.read_bytes()


def test_fitting_again_keeps_what_was_added_to_the_instrument(whole_fit, tmp_path):
    target = tmp_path / "mine.toml"
    whole_fit.save(target)
    target.write_text(target.read_text() + "[string_1]\nT = 52.0\n")
    fewer = replace(whole_fit, warnings=("another",))
    with pytest.raises(OutputError, match=r"mine\.body\.json: exists; --overwrite"):
        fewer.save(target)
    assert read_fit(target).warnings == whole_fit.warnings
    assert fewer.save(target, overwrite=True) == (tmp_path / "mine.body.json",)
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


RISING = ("measured", "admittance", "frequency_hz")


@pytest.mark.parametrize(
    ("where", "change", "told"),
    [
        (("measured", "admittance", "real"), lambda _: [1.0], r"mine\.json"),
        (RISING, lambda _: None, r"mine\.json"),
        (("measured",), lambda _: 7, r"mine\.json"),
        (("fit", "band_hz"), lambda _: [1.0], r"mine\.json"),
        (("fit", "warnings"), lambda _: None, r"mine\.json"),
        (("fit", "admittance_db"), lambda _: {"rms": "x"}, r"mine\.json"),
        (RISING, lambda column: column[::-1], "do not rise"),
        (RISING, lambda column: [0.0, *column[1:]], "do not rise"),
        (RISING, lambda column: [*column[:-1], column[-2]], "do not rise"),
        (RISING, lambda column: [*column[:-1], math.inf], "not finite"),
    ],
)
def test_damaged_measurements_are_reported(whole_fit, tmp_path, where, change, told):
    whole_fit.save(tmp_path / "mine.json")
    data = entry = json.loads((tmp_path / "mine.json").read_text())
    for key in where[:-1]:
        entry = entry[key]
    entry[where[-1]] = change(entry[where[-1]])
    (tmp_path / "mine.json").write_text(json.dumps(data))
    with pytest.raises(MeasurementError, match=told):
        read_fit(tmp_path / "mine.json")


@pytest.mark.parametrize("kind", ["presets/hall", "mappings/wind", "examples/dataset", "", "base"])
def test_toml_of_another_kind_is_no_instrument(tmp_path, kind):
    path = tmp_path / "x.toml"
    text = {"": "", "base": 'base = "keyboard"\n[[bind]]\n'}
    path.write_text(text[kind] if kind in text else (ROOT / f"{kind}.toml").read_text("utf-8"))
    with pytest.raises(MeasurementError, match=r"x\.toml: is not an instrument or body file"):
        read_fit(path)


def test_an_instrument_on_the_base_of_another_has_its_body(whole_fit, tmp_path):
    whole_fit.save(tmp_path / "mine.toml")
    (tmp_path / "slack.toml").write_text('base = "mine.toml"\n[string_1]\nT = 52.0\n')
    assert read_fit(tmp_path / "slack.toml").body == whole_fit.body


@pytest.mark.parametrize("text", ["", "{}", "[1]", '{"bridge_modes": 1}', "x"])
def test_what_is_no_body_is_reported(tmp_path, text):
    (tmp_path / "x.json").write_text(text)
    with pytest.raises((MeasurementError, ParameterError), match=r"x\.json"):
        read_fit(tmp_path / "x.json")
