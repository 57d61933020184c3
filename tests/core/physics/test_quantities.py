"""Instrument files: what they may hold, and what is refused by name."""

import json
import math
from dataclasses import fields, replace
from importlib.resources import files
from itertools import product
from pathlib import Path

import pytest

from yehu_server.core.physics.default_quantities import (
    Quantities,
    override,
    read_body,
    read_quantities,
)
from yehu_server.core.physics.grid import check_rate, intervals
from yehu_server.core.physics.layout import MAX_INTERVALS
from yehu_server.errors import ParameterError
from yehu_server.scores.gesture import gesture_from, on_instrument

YEHU = Quantities()
BODY = json.loads(files("yehu_server.core.physics").joinpath("body.json").read_text())


# [Yehu] table 1 and the published numbers, typed independently.
MEASURED = {
    "string_1": "L 0.38 rho 1250 r 0.55e-3 T 50.61 E 1e10 sigma_0 0.9754 sigma_1 0.0026",
    "string_2": "L 0.38 rho 1350 r 0.40e-3 T 64.29 E 9.5e9 sigma_0 1.5844 sigma_1 0.0032",
    "bow": "epsilon_0 3.186e4 epsilon_1 0.0027 v_s 0.228 mu_C 0.5071 mu_S 1.0207"
    " M_h 4.5e-3 K_h 4.8297e4 R_h 5.7674",
    "finger": "M_f 0.02 K_f 5e5 alpha 2.3 beta 20 rest_height 0.5e-3",
}


def test_the_default_instrument_is_the_measured_one():
    for section, values in MEASURED.items():
        words = values.split()
        for name, value in zip(words[::2], words[1::2], strict=True):
            assert getattr(getattr(YEHU, section), name) == float(value), (section, name)
    assert (YEHU.bridge_x, YEHU.bow.xi) == (0.30, (0.7, 0.4))
    assert (len(YEHU.body.mass), len(YEHU.body.sections)) == (11, 25)
    for string, impedance in zip(YEHU.strings, (0.245, 0.209), strict=True):
        assert math.sqrt(string.T * string.rho_A) == pytest.approx(impedance, abs=5e-4)


def test_a_change_changes_that_quantity_and_no_other():
    changed = override(YEHU, {"bow": {"epsilon_0": 30000, "xi": [0.6, 0.5]}, "bridge_x": 0.29})
    assert changed.bow == replace(YEHU.bow, epsilon_0=3e4, xi=(0.6, 0.5))
    assert isinstance(changed.bow.epsilon_0, float)
    assert changed == replace(YEHU, bow=changed.bow, bridge_x=0.29)
    assert override(YEHU, {}) == YEHU


def test_a_mistake_is_refused_by_name(subtests):
    for changes, named in [
        ({"bows": {}}, "instrument.bows: unknown entry; did you mean bow?"),
        ({"bow": {"epsilon1": 1.0}}, "bow.epsilon1: unknown entry; did you mean epsilon_1?"),
        ({"string_1": {"rho_A": 1e-3}}, "string_1.rho_A: unknown entry"),
        ({"bow": 3.0}, "bow: expected a table of names and values, got 3.0"),
        ({"bow": None}, "bow: expected a table"),
        ([["bow", {}]], "instrument: expected a table"),
        ({"bow": {"mu_S": "1.0"}}, "bow.mu_S: expected a number, got '1.0'"),
        ({"bow": {"mu_S": True}}, "bow.mu_S: expected a number, got true"),
        ({"bow": {"mu_S": None}}, "bow.mu_S: expected a number, got None"),
        ({"bow": {"mu_S": [1.0]}}, "bow.mu_S: expected a number"),
        ({"bow": {"base": "yehu.toml"}}, "bow.base: unknown entry"),
        ({"bow": {"points": 2.5}}, "bow.points: expected a whole number from 2 to 4, got 2.5"),
        ({"bow": {"points": 5}}, "bow.points: 5 is not within 2 to 4"),
        ({"bow": {"hair": 0.5}}, "bow.hair: expected a whole number from 0 to 65535, got 0.5"),
        ({"bow": {"xi": 0.5}}, "bow.xi: expected 2 numbers, got 0.5"),
        ({"bow": {"xi": [0.5]}}, "bow.xi: expected 2 numbers"),
        ({"bow": {"xi": [0.5, 0.5, 0.5]}}, "bow.xi: expected 2 numbers"),
        ({"bow": {"xi": [0.5, 1.0]}}, "bow.xi: 1.0 is not within"),
        ({"bridge_x": 0.5}, "bridge_x 0.5 m lies off the string"),
        ({"bow": {"mu_S": 0.4}}, "mu_S must not be below mu_C"),
        ({"bow": {"friction": "hot"}}, "bow.friction: 'hot' is not one of elasto-plastic"),
        ({"torsion": "yes"}, "torsion: 'yes' is not one of off, on"),
        ({"body": "no/such/file.json"}, "body: no/such/file.json"),
        ({"body": 7}, "body: 7: no such"),
    ]:
        with subtests.test(changes=changes, named=named):
            with pytest.raises(ParameterError) as error:
                override(YEHU, changes)
            assert named in str(error.value)
            assert "\n" not in str(error.value)


def test_every_quantity_refuses_what_is_beyond_its_bounds(subtests):
    bounded = [
        (section, item)
        for section in MEASURED
        for item in fields(getattr(YEHU, section))
        if "unit" in item.metadata
    ]
    assert len(bounded) > 30
    for section, item in bounded:
        with subtests.test(section=section, item=item):
            lo, hi = item.metadata["lo"], item.metadata["hi"]
            pair = isinstance(item.default, tuple)
            beyond = [lo - max(abs(lo), 1e-3), 2.0 * hi, math.nan, math.inf, -math.inf, 10**400]
            for value in beyond:
                given = [value, value] if pair else value
                with pytest.raises(ParameterError, match=rf"^instrument\.{section}\.{item.name}: "):
                    override(YEHU, {section: {item.name: given}})
            assert lo <= (item.default[0] if pair else item.default) <= hi
            assert item.metadata["unit"]
            assert item.metadata["source"]
    for name, value in product(("bridge_x", "tension_headroom"), (math.nan, math.inf, -1.0)):
        with pytest.raises(ParameterError, match=name):
            override(YEHU, {name: value})


# --- body files ---------------------------------------------------------------------------


def written(folder, body):
    path = folder / "body.json"
    text = body if isinstance(body, str | bytes) else json.dumps(body)
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    return path


def with_changes(**changes):
    """The measured body with one thing changed: key=value, where mode_ keys go to a mode."""
    body = json.loads(json.dumps(BODY))
    for key, value in changes.items():
        if key.startswith("mode_"):
            body["bridge_modes"][3][key.removeprefix("mode_")] = value
        else:
            body["radiation"][key] = value
    return body


SECTIONS = BODY["radiation"]["sections"]
MALFORMED = {
    "empty": "",
    "not json": "{'bridge_modes': }",
    "nested without end": "[" * 200_000,
    "no text": b"\xff\xfe\x00\x01" * 9,
    "no object": "[1, 2]",
    "a number": "7",
    "null": "null",
    "no modes": {"radiation": BODY["radiation"]},
    "no radiation": {"bridge_modes": BODY["bridge_modes"]},
    "modes are numbers": {**BODY, "bridge_modes": [1.0, 2.0]},
    "no mode at all": {**BODY, "bridge_modes": []},
    "a mode without mass": {**BODY, "bridge_modes": [{"frequency_hz": 1.0}]},
    "mass in words": with_changes(mode_mass_kg="heavy"),
    "mass null": with_changes(mode_mass_kg=None),
    "mass zero": with_changes(mode_mass_kg=0.0),
    "mass negative": with_changes(mode_mass_kg=-0.1),
    "mass NaN": with_changes(mode_mass_kg=math.nan),
    "mass beyond numbers": with_changes(mode_mass_kg=10**400),
    "frequency infinite": with_changes(mode_frequency_hz=math.inf),
    "frequency zero": with_changes(mode_frequency_hz=0.0),
    "damping negative": with_changes(mode_damping_kg_per_s=-1e-6),
    "rate zero": with_changes(sample_rate_hz=0.0),
    "gain NaN": with_changes(direct_gain=math.nan),
    "section of three": with_changes(sections=[[1.0, 0.0, 0.0]]),
    "section of words": with_changes(sections=[["a", "b", "c", "d"]]),
    "section unstable": with_changes(sections=[*SECTIONS, [1e-3, 0.0, -1.9, 1.001]]),
    "section with a real pole outside": with_changes(sections=[[1e-3, 0.0, -2.1, 0.99]]),
    "section on the circle": with_changes(sections=[[1e-3, 0.0, 0.0, 1.0]]),
    "section NaN": with_changes(sections=[[math.nan, 0.0, 0.0, 0.0]]),
}


def test_a_malformed_or_unstable_body_is_refused_by_its_file_name(tmp_path, subtests):
    for name, body in MALFORMED.items():
        with subtests.test(name):
            path = written(tmp_path, body)
            with pytest.raises(ParameterError) as error:
                read_body(path)
            assert str(path) in str(error.value)
            assert "\n" not in str(error.value)


# --- rates and grids ----------------------------------------------------------------------


def test_sample_rates_from_22050_to_192000_are_possible():
    for rate in (22050.0, 44100.0, 192000.0):
        check_rate(rate)
    for rate in (0.0, -44100.0, 22049.0, 192001.0, math.inf, math.nan):
        with pytest.raises(ParameterError, match="sample rate"):
            check_rate(rate)


def test_a_string_too_short_or_too_fine_for_its_grid_is_refused():
    stiff = override(YEHU, {"string_1": {"L": 0.35, "T": 500.0, "r": 5e-3, "E": 1e12}})
    with pytest.raises(ParameterError, match="grid intervals"):
        intervals(stiff.string_1, 1.0 / 22050.0)
    slack = override(YEHU, {"string_1": {"L": 1.0, "T": 1.0, "E": 0.0, "sigma_1": 0.0}})
    with pytest.raises(ParameterError, match=str(MAX_INTERVALS)):
        intervals(slack.string_1, 1.0 / 192000.0)


def test_the_papers_instrument_is_shipped_and_a_base_everywhere(tmp_path, monkeypatch):
    """[Yehu] section 2: constant tension, no felt, one point of hair, no torsion."""
    monkeypatch.chdir(tmp_path)
    paper = override(Quantities(), {"base": "paper"})
    plain = {"tension_modulation": 0.0, "felt_loss": 0.0, "tension_headroom": 1.0}
    assert paper == override(Quantities(), plain)
    refined = {"base": "paper", "torsion": "on", "bow": {"width": 0.008}}
    assert override(paper, refined) == override(paper, {"torsion": "on", "bow": {"width": 0.008}})
    assert read_quantities(Path("paper")) == paper
    own = tmp_path / "mine.toml"
    own.write_text('base = "paper"\nbridge_x = 0.29\n')
    assert read_quantities(own) == replace(paper, bridge_x=0.29)
    assert gesture_from({"instrument": {"base": "paper"}}).quantities == paper
    named = on_instrument({}, Path("paper"))  # --instrument paper
    assert gesture_from(named).quantities == paper
    with pytest.raises(ParameterError, match="papper"):
        override(Quantities(), {"base": "papper"})
