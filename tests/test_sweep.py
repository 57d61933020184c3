"""``yehu-server sweep``: variations of a gesture, simulated on all cores."""

from __future__ import annotations

import json

import numpy as np
import pytest

from yehu_server import sweep as sweeping
from yehu_server.cli import main
from yehu_server.errors import ParameterError
from yehu_server.score.gesture import gesture_from
from yehu_server.simulate import simulate
from yehu_server.sweep import axis_of, sweep, variations

GESTURE = {
    "duration": 0.15,
    "controls": {
        "bow_force": [[0, 0.0], [0.02, 0.7]],
        "bow_velocity": [[0, 0.0], [0.03, 0.2]],
        "finger_position": 0.1,
        "press_force": 1.5,
    },
}


@pytest.fixture
def gesture(tmp_path):
    file = tmp_path / "gesture.json"
    file.write_text(json.dumps(GESTURE))
    return file


@pytest.mark.parametrize(
    ("text", "path", "values"),
    [
        ("bow_force=0.1,2", ("controls", "bow_force"), (0.1, 2.0)),
        ("controls.bow_force=-1e-1", ("controls", "bow_force"), (-0.1,)),
        ("instrument.bow.epsilon_0=1e4:3e4:3", ("instrument", "bow", "epsilon_0"), (1e4, 2e4, 3e4)),
        ("duration=0.1", ("duration",), (0.1,)),
    ],
)
def test_an_axis_is_a_name_and_values(text, path, values):
    axis = axis_of(text)
    assert axis.path == path
    assert axis.values == pytest.approx(values)


@pytest.mark.parametrize(
    "text",
    ["bow_force", "=1", "bow_force=", "bow_force=1:2", "bow_force=1:2:1", "a..b=1", "x=1:2:z"],
)
def test_what_is_no_axis_is_refused(text):
    with pytest.raises(ParameterError):
        axis_of(text)


def test_every_combination_is_run_the_last_axis_changing_fastest():
    axes = [axis_of("bow_force=0.4,0.7"), axis_of("finger_position=0.08,0.1,0.12")]
    varied = [values for values, _ in variations(GESTURE, axes)]
    assert [tuple(values.values()) for values in varied] == [
        (force, place) for force in (0.4, 0.7) for place in (0.08, 0.1, 0.12)
    ]


def test_a_curve_keeps_its_shape_and_another_entry_is_set():
    (run,) = variations(GESTURE, [axis_of("bow_force=-1.4"), axis_of("press_force=2")])
    _, gesture = run
    assert gesture.controls["bow_force"] == ((0.0, 0.0), (0.02, pytest.approx(-1.4)))
    assert gesture.controls["press_force"] == ((0.0, 2.0),)
    assert GESTURE["controls"]["bow_force"] == [[0, 0.0], [0.02, 0.7]]


def test_a_run_of_a_sweep_is_the_same_as_alone_to_the_bit(tmp_path):
    runs = variations(GESTURE, [axis_of("bow_force=0.3:1:5"), axis_of("bow_velocity=0.1,0.2")])
    rows = sweep(runs, tmp_path / "runs", workers=4)
    assert [row["varied"] for row in rows] == [varied for varied, _ in runs]
    assert json.loads((tmp_path / "runs" / "index.json").read_text()) == rows
    for row, (_, gesture) in zip(rows, runs, strict=True):
        alone = simulate(gesture)
        with np.load(tmp_path / "runs" / row["file"]) as file:
            assert (file["pressure"] == alone.arrays["pressure"]).all()


def test_an_index_tells_pitch_and_level(tmp_path):
    long = GESTURE | {"duration": 0.5}
    rows = sweep(variations(long, [axis_of("finger_position=0.1,0.13")]), tmp_path, keep=False)
    low, high = rows
    assert {path.name for path in tmp_path.iterdir()} == {"index.json"}
    assert 500.0 < low["pitch_hz"] < high["pitch_hz"] < 640.0
    assert low["pressure_rms"] > 0.01
    assert low["lost_states"] == low["unconverged_solves"] == 0


def test_a_silent_run_has_no_pitch(tmp_path):
    (row,) = sweep([({}, gesture_from({}))], tmp_path, keep=False)
    assert row["pitch_hz"] is None
    assert row["pressure_rms"] == 0.0


def test_the_command_writes_arrays_and_index(gesture, tmp_path, capsys):
    words = ["sweep", str(gesture), "-o", str(tmp_path / "runs"), "--vary", "bow_force=0.4,0.7"]
    assert main([*words, "--energy", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["runs"] == 2
    assert {path.name for path in (tmp_path / "runs").iterdir()} == {"0.npz", "1.npz", "index.json"}
    with np.load(tmp_path / "runs" / "1.npz") as file:
        assert np.abs(file["energy_error"]).max() < 1e-9


@pytest.mark.parametrize(
    ("vary", "wrong"),
    [
        ("bow_force=99", "bow_force: 99.0 is not within"),
        ("bow_farce=1", "unknown name 'bow_farce'"),
        ("instrument.bow.nothing=1", "unknown quantity 'nothing'"),
        ("duration.x=1", "no such entry"),
        ("bow_force=1:2:50000", "runs are more than"),
    ],
)
def test_what_cannot_be_varied_is_told_before_anything_runs(gesture, tmp_path, capsys, vary, wrong,
                                                             monkeypatch):  # fmt: skip
    monkeypatch.setattr(sweeping, "MOST_RUNS", 40_000)
    monkeypatch.setattr(sweeping, "_steps", int)
    assert main(["sweep", str(gesture), "-o", str(tmp_path / "runs"), "--vary", vary]) == 2
    assert wrong in capsys.readouterr().err
    assert not (tmp_path / "runs").exists()


@pytest.fixture
def swept(gesture, tmp_path):
    """Sweep into a folder; return the names of the files in it."""

    def run(values: str, *words: str, code: int = 0) -> set[str]:
        vary = ("--vary", f"bow_force={values}", "--quiet")
        assert main(["sweep", str(gesture), "-o", str(tmp_path / "runs"), *vary, *words]) == code
        return {path.name for path in (tmp_path / "runs").iterdir()}

    return run


def test_a_sweep_before_is_kept_unless_it_may_be_overwritten(swept, tmp_path, capsys):
    first = swept("0.4,0.5,0.6")
    (tmp_path / "runs" / "mine.npz").write_text("mine")
    (tmp_path / "runs" / "notes.txt").write_text("mine")
    index = (tmp_path / "runs" / "index.json").read_text()
    assert swept("0.7", code=2) == first | {"mine.npz", "notes.txt"}
    assert "--overwrite" in capsys.readouterr().err
    assert (tmp_path / "runs" / "index.json").read_text() == index
    assert swept("0.7", "--overwrite") == {"0.npz", "index.json", "mine.npz", "notes.txt"}
    assert swept("0.7", "--overwrite", "--index-only") == {"index.json", "mine.npz", "notes.txt"}


def test_what_no_index_tells_of_is_never_removed(swept, tmp_path, capsys):
    (tmp_path / "runs").mkdir()
    (tmp_path / "runs" / "07.npz").write_text("of a sweep that was killed")
    assert swept("0.7", "--overwrite", code=2) == {"07.npz"}
    assert "07.npz: is in no index" in capsys.readouterr().err
    (tmp_path / "runs" / "07.npz").unlink()
    (tmp_path / "runs" / "index.json").write_text("<html>")
    assert swept("0.7", "--overwrite", code=2) == {"index.json"}
    assert "is not the index of a sweep" in capsys.readouterr().err


@pytest.mark.parametrize("rows", [[3], [{"file": "../mine.npz"}], [{"file": 3}], []])
def test_an_index_removes_nothing_but_results(swept, tmp_path, rows):
    (tmp_path / "runs").mkdir()
    (tmp_path / "mine.npz").write_text("mine")
    (tmp_path / "runs" / "index.json").write_text(json.dumps(rows))
    assert swept("0.7", "--overwrite") == {"0.npz", "index.json"}
    assert (tmp_path / "mine.npz").exists()


def test_what_is_done_when_a_sweep_is_interrupted_stays_and_is_indexed(gesture, tmp_path):
    source = json.loads(gesture.read_text())
    runs = variations(source, [axis_of("bow_force=0.4,0.5,0.6,0.7")])

    def interrupt(done: float, _total: float) -> None:
        if done == 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt, match="of 4 runs are in"):
        sweep(runs, tmp_path / "runs", workers=1, progress=interrupt)
    rows = json.loads((tmp_path / "runs" / "index.json").read_text())
    files = {path.name for path in (tmp_path / "runs").glob("*.npz")}
    assert {row["file"] for row in rows} == files
    assert len(rows) >= 2
    assert len(sweep(runs[:1], tmp_path / "runs", overwrite=True)) == 1
    assert {path.name for path in (tmp_path / "runs").glob("*.npz")} == {"0.npz"}


def test_a_folder_that_cannot_be_made_is_told(gesture, tmp_path, capsys):
    (tmp_path / "file").write_text("")
    words = ["sweep", str(gesture), "-o", str(tmp_path / "file"), "--vary", "bow_force=1"]
    assert main(words) == 2
    assert "File exists" in capsys.readouterr().err
