"""``yehu-server sweep``: studies and varied gestures, on all cores, and their pictures."""

import json
import shutil

import numpy as np
import pytest
from clusters import cluster_in, needs_distributed

from yehu_lab.sweeps.result import Result
from yehu_server.cli import main
from yehu_server.rendering import cluster_worker
from yehu_server.simulation.run import simulate

GESTURE = {
    "duration": 0.1,
    "controls": {
        "bow_force": [[0, 0.0], [0.02, 0.7]],
        "bow_velocity": [[0, 0.0], [0.03, 0.2]],
        "finger_position": 0.1,
        "press_force": 1.5,
    },
}
STUDY = """
about = "Light and heavy"
duration = 0.1
[stroke]
note = 72
acceleration = 20.0
[vary]
force = { from = 0.1, to = 1.0, steps = 3, spread = "log" }
position = [0.1, 0.16]
"""


@pytest.fixture
def gesture(tmp_path):
    file = tmp_path / "gesture.json"
    file.write_text(json.dumps(GESTURE))
    return str(file)


@pytest.fixture
def study(tmp_path):
    file = tmp_path / "study.toml"
    file.write_text(STUDY)
    return str(file)


def test_a_study_makes_one_file(study, tmp_path, capsys):
    target = tmp_path / "found.npz"
    assert main(["sweep", study, "-o", str(target), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    result = Result.load(target)
    assert told["strokes"] == len(result) == 6
    assert sum(told["regimes"].values()) == 6
    assert list(result.axes) == ["force", "position"]
    assert sorted(path.name for path in tmp_path.iterdir()) == ["found.npz", "study.toml"]


def test_a_gesture_is_varied_and_its_signals_kept(gesture, tmp_path):
    target, folder = tmp_path / "found.npz", tmp_path / "runs"
    words = ["--vary", "bow_force=0.3:1:2", "--vary", "bow_velocity=0.1,0.2", "--quiet"]
    keep = ["--signals", str(folder), "--energy", "--strings", "100"]
    assert main(["sweep", gesture, "-o", str(target), *words, *keep]) == 0
    assert {path.name for path in folder.glob("*.npz")} == {f"{i}.npz" for i in range(4)}
    study = Result.load(target).study()
    alone = simulate(study.bow.gesture(study.axes, [1, 0])).arrays
    with np.load(folder / "2.npz") as file:
        assert (file["pressure"] == alone["pressure"]).all()
        assert np.abs(file["energy_error"]).max() < 1e-9
        assert len(file["strings_time"]) == 45  # 4410 samples, from 0


def test_signals_of_another_sweep_are_kept_unless_they_may_be_overwritten(
    gesture, tmp_path, capsys
):
    folder = tmp_path / "runs"

    def run(values, *more):
        words = ["--vary", f"bow_force={values}", "--signals", str(folder), "--quiet", *more]
        return main(["sweep", gesture, "-o", str(tmp_path / f"{values}.npz"), *words])

    assert run("0.4,0.5") == 0
    (folder / "mine.npz").write_text("mine")
    before = (folder / "0.npz").read_bytes()
    assert run("0.7") == 2
    assert "signals of another sweep" in capsys.readouterr().err
    assert (folder / "0.npz").read_bytes() == before
    assert run("0.7", "--overwrite") == 0
    names = {path.name for path in folder.iterdir()}
    assert names == {"0.npz", "mine.npz", "study.json"}


def test_a_wrong_call_is_reported_in_a_line_before_anything_runs(gesture, study, tmp_path, refused):
    refined = tmp_path / "refined.toml"
    refined.write_text(STUDY + '[refine]\naxes = ["force"]\nlevels = 1\n')
    for words, wrong in (
        (
            (gesture, "--vary", "bow_force=99"),
            "--vary: gesture.controls.bow_force: 99.0 is not",
        ),
        ((gesture, "--vary", "bow_farce=1"), "yehu-server: --vary: bow_farce: unknown entry"),
        ((gesture, "--vary", "bow_force=1:2"), "--vary bow_force=1:2: expected numbers"),
        ((gesture,), "nothing is varied"),
        ((refined, "--signals", tmp_path / "runs"), "a study with [refine] keeps no signals"),
        ((study, "--signals", study), "file exists"),
    ):
        assert wrong in refused("sweep", "-o", tmp_path / "found.npz", *words)
        assert not (tmp_path / "found.npz").exists()


@pytest.mark.slow
@needs_distributed
def test_a_cluster_finds_to_the_byte_what_one_machine_does(command, gesture, tmp_path):
    cluster_worker.identity.cache_clear()  # code may be edited while tests run
    # Not in the order of the alphabet.
    varied = ("--vary", "bow_velocity=0.1,0.2", "--vary", "bow_force=0.2:2:4")
    with cluster_in(tmp_path) as cluster:
        for name, words in (("here", ()), ("there", ("--dask", cluster.file))):
            target = tmp_path / f"{name}.npz"
            code, _, err = command("sweep", gesture, "-o", target, *varied, *words)
            assert code == 0, err
    assert (tmp_path / "there.npz").read_bytes() == (tmp_path / "here.npz").read_bytes()


@pytest.fixture(scope="module")
def swept(tmp_path_factory):
    folder = tmp_path_factory.mktemp("swept")
    (folder / "study.toml").write_text(STUDY)
    words = [str(folder / "study.toml"), "-o", str(folder / "found.npz"), "--quiet"]
    assert main(["sweep", *words]) == 0
    return folder / "found.npz"


@pytest.fixture
def found(swept, tmp_path):
    return shutil.copy(swept, tmp_path / "found.npz")


@pytest.mark.parametrize(
    "column", ["regime", pytest.param("helmholtz_s", marks=pytest.mark.slow), "pitch_hz"]
)
def test_a_result_is_drawn(found, tmp_path, column):
    pytest.importorskip("matplotlib")
    assert main(["sweep", "show", str(found), "--column", column, "--quiet"]) == 0
    picture = (tmp_path / "found.png").read_bytes()
    assert picture.startswith(b"\x89PNG")
    assert len(picture) > 10_000


def test_what_cannot_be_drawn_is_reported(found, tmp_path, monkeypatch, refused):
    pytest.importorskip("matplotlib")
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.png").write_text("mine")
    for words, wrong in (
        (("none.npz",), "none.npz: no such file"),
        ((found, "-o", "out.gif"), "name a picture .png, or a page .html"),
        ((found, "--column", "pitch"), "unknown column 'pitch'"),
        ((found, "-o", found), "name a picture"),
        ((found, "-o", "mine.png"), "exists"),
    ):
        assert wrong in refused("sweep", "show", *words)
    assert found.exists()
    assert (tmp_path / "mine.png").read_text() == "mine"


def test_the_forces_that_keep_and_start_a_motion_are_printed(tmp_path, capsys):
    file, target = tmp_path / "study.toml", str(tmp_path / "found.npz")
    vary = "[vary]\nforce = [0.001, 0.3, 0.5, 0.7]\nposition = [0.13, 0.2]\n"
    file.write_text("duration = 0.2\n[stroke]\nstring = 2\nnote = 77\n" + vary)
    assert main(["sweep", str(file), "-o", target, "--quiet"]) == 0
    assert main(["sweep", "forces", target, "--json"]) == 0
    near, far = json.loads(capsys.readouterr().out)["thresholds"]
    assert near["at"] == {"position": 0.13}
    assert near["start"] in (0.3, 0.5)
    assert 0.0 < near["keep"] < near["start"] <= near["greatest"] <= 0.7
    # Schelleng's limits go as the inverse square of the place, and as its inverse.
    assert near["keep"] / far["keep"] == pytest.approx((0.2 / 0.13) ** 2)
    assert near["bear"] / far["bear"] == pytest.approx(0.2 / 0.13)
    assert main(["sweep", "forces", target]) == 0
    assert capsys.readouterr().out.startswith("position 0.13: to keep 0.0")


def test_an_island_of_forces_is_no_threshold():
    from yehu_lab.sweeps.thresholds import ends_of

    forces = np.array([3.0, 2.5, 2.0, 1.0, 0.5, 0.2])  # as of a string with negative forces
    speaks = np.array([True, False, True, True, True, False])
    assert ends_of(speaks, forces) == (0.5, 2.0)
    assert np.isnan(ends_of(~speaks & speaks, forces)).all()
