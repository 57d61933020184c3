"""The file of a sweep."""

import tracemalloc

import numpy as np
import pytest

from yehu_lab.sweeps.result import COLUMNS, Result
from yehu_server.errors import ScoreError


def test_a_file_holds_all_of_a_result(tmp_path, result):
    result.save(tmp_path / "mine.npz")
    again = Result.load(tmp_path / "mine.npz")
    assert again.meta == result.meta
    assert list(again.axes) == list(result.axes)
    assert np.array_equal(again.numbers, result.numbers)
    for name in COLUMNS:
        assert again.columns[name].tobytes() == result.columns[name].tobytes()


def test_xarray_has_names_values_and_units(result):
    pytest.importorskip("xarray")
    data = result.to_xarray()
    assert data["pitch_hz"].dims == ("force", "position")
    assert data["pitch_hz"].attrs["units"] == "Hz"
    assert int(data["computed"].sum()) == len(result)
    at = data.sel(force=5.0, position=0.06)
    assert int(at["regime"]) == result.grid("regime")[-1, 0]


def test_a_damaged_or_another_file_is_reported_in_a_line(tmp_path, result):
    target = tmp_path / "mine.npz"
    result.save(target)
    whole = target.read_bytes()
    for cut in (0, 10, 400):
        target.write_bytes(whole[:cut])
        with pytest.raises(ScoreError, match=r"mine\.npz: is not the result of a sweep"):
            Result.load(target)
    for arrays in ({"a": np.zeros(3)}, result.arrays() | {"numbers": result.numbers + 10**6}):
        np.savez(target, **arrays)
        with pytest.raises(ScoreError, match=r"mine\.npz: is not the result"):
            Result.load(target)
    with pytest.raises(ScoreError, match="no such file"):
        Result.load(tmp_path / "none.npz")


def test_a_small_file_that_claims_much_is_refused_before_it_is_read(tmp_path, result):
    count = 2**21
    arrays = result.arrays()
    same = {name: np.zeros(count, arrays[name].dtype) for name in COLUMNS}
    huge = {"numbers": np.zeros(count, np.int64)} | same
    axes = [f"axis_{name}" for name in result.axes]
    wide = dict(zip(axes, (np.arange(2**17), np.arange(2**8)), strict=True))
    taken = []
    for claim in (huge, wide):
        np.savez_compressed(tmp_path / "mine.npz", **(arrays | claim))
        tracemalloc.start()
        try:
            Result.load(tmp_path / "mine.npz")
        except ScoreError:
            if tracemalloc.get_traced_memory()[1] < 10**7:
                continue
        finally:
            tracemalloc.stop()
        taken.append(list(claim))
    assert taken == []


def test_flattening_is_measured_against_the_median_of_the_same_note():
    pitches = np.array([[440.0, 438.0, 436.0, 200.0], [880.0, 880.0, 870.0, 870.0]])
    columns = {name: np.zeros(8) for name in COLUMNS}
    columns |= {"pitch_hz": pitches.reshape(-1), "regime": np.array([2, 2, 2, 3, 2, 2, 2, 2])}
    axes = {"note": np.array([69.0, 81.0]), "force": np.array([0.1, 0.2, 0.4, 0.8])}
    meta = {"refine": [], "levels": 0}
    found = Result(meta, axes, np.arange(8), columns).flattening()
    expected = 1200.0 * np.log2([[440.0 / 438.0, 1.0, 436.0 / 438.0], [880.0 / 875.0] * 3])
    expected[1, 2] = 1200.0 * np.log2(870.0 / 875.0)
    np.testing.assert_allclose(found[:, :3], expected)
    assert np.isnan(found[0, 3])
    columns["regime"][:] = 3
    assert np.isnan(Result(meta, axes, np.arange(8), columns).flattening()).all()
