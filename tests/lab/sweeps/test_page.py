"""The page of a result, and what it is made of."""

import base64
import subprocess
import zlib
from types import SimpleNamespace

import numpy as np
import pytest
from live.page.browser import SHELL

from yehu_lab.plot.cells import is_log
from yehu_lab.plot.study import facts_of, limits_along, write_page
from yehu_lab.sweeps.study import study_of


def test_a_page_has_regimes_levels_and_flattening_in_their_places(result):
    columns = facts_of(result, "position", "force")["columns"]

    def cells(column):
        return np.frombuffer(zlib.decompress(base64.b64decode(column["data"])), np.uint8)

    regime, level, flat = (
        next(column for column in columns if column.get(key) == value)
        for key, value in (("label", columns[0]["label"]), ("label", "level"), ("unit", "cents"))
    )
    assert (cells(regime).reshape(9, 5) == result.grid("regime")).all()
    assert [regime["regimes"][k] for k in (2, 6)] == ["helmholtz", "raucous"]
    shown = level["low"] + level["step"] * cells(level).reshape(9, 5)
    assert np.abs(shown - result.grid("level_db")).max() <= 0.51 * level["step"]
    found = result.flattening().reshape(-1)
    assert flat["step"] < 0.5
    assert ((cells(flat) == 255) == np.isnan(found)).all()
    inside = np.isfinite(found) & (found > flat["low"]) & (found < 30.0)
    shown = flat["low"] + flat["step"] * cells(flat)
    assert np.abs(shown - found)[inside].max() <= 0.51 * flat["step"]


def test_limits_lie_on_the_side_of_the_forces():
    gesture = {"duration": 0.15, "controls": {"bow_velocity": 0.2}}
    for sign in (1.0, -1.0):  # below zero they are on the outer string
        vary = {"bow_position": [0.24, 0.25, 0.27], "bow_force": [-0.1 * sign, 2.0 * sign]}
        study = study_of({"gesture": gesture, "vary": vary})
        result = SimpleNamespace(axes={axis.name: axis.as_array() for axis in study.axes})
        at, lower, upper = limits_along(result, study, "bow_position", "bow_force", {})
        assert at.tolist() == [0, 1, 2]
        assert (sign * upper > sign * lower).all()
        assert (sign * lower > 0.0).all()


def test_values_are_drawn_by_logarithms_where_they_have_equal_ratios_or_go_far(subtests):
    for values, spread, log in [
        ([1.0, 2.0, 3.0, 4.0, 5.0, 6.0], "", False),
        ([1.0, 2.0, 4.0], "", True),
        ([4.0, 1.0, 2.0], "", True),
        ([1.0, 7.0, 9.0], "", True),
        ([1.0, 3.0, 4.0], "", False),
        ([0.0, 1.0, 10.0], "", False),
        ([1.0, 10.0], "", True),
        ([1.0, 2.0, 3.0], "log", True),
        ([1.0, 10.0], "linear", False),
        ([0.5], "", False),
        (["a", "b"], "", False),
    ]:
        with subtests.test(values=values, spread=spread, log=log):
            assert is_log(np.array(values), spread) is log


@pytest.mark.skipif(SHELL is None, reason="needs chromium")
def test_a_browser_draws_the_page_from_the_file_alone(tmp_path, result):
    write_page(result, tmp_path / "page.html")
    command = [
        SHELL, "--headless", "--no-sandbox", "--disable-gpu", "--virtual-time-budget=4000",
        f"--user-data-dir={tmp_path / 'profile'}", "--dump-dom", f"file://{tmp_path}/page.html",
    ]  # fmt: skip
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=True)
    assert '<li><span style="background: rgb(47, 143, 91);"></span>helmholtz</li>' in done.stdout
    assert "upper (whole) and lower" in done.stdout
