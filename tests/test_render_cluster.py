"""``yehu-server render FOLDER --dask``: a folder on a cluster of workers."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Self

import pytest
from clusters import cluster_in, needs_distributed
from commands import is_one_line, results_in
from forks import in_the_place_of_workers, start
from midi_files import midi_file, notes
from waiting import LONG_S, until

from yehu_server.cli import main
from yehu_server.rendering import cluster_worker
from yehu_server.rendering.workers import Event

pytestmark = needs_distributed

DRY = ("--dry", "--mono", "--tail", "0")
SCORES = 8
SETTINGS = '{"bow": {"epsilon_0": 30000.0}}'


@pytest.fixture(autouse=True)
def _as_it_is_now() -> None:
    """Code may be edited while tests run: a test has what is there when it starts."""
    cluster_worker.identity.cache_clear()


def tune(path: Path, note: int, seconds: float = 0.2) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    midi_file(path, notes((0.0, seconds, note, 90)))


def write_songs(folder: Path) -> Path:
    """Scores in `in`, one of them broken."""
    for number in range(SCORES):
        tune(folder / "in" / f"{number % 2}" / f"{number}.mid", 66 + number)
    (folder / "in" / "broken.mid").write_bytes(b"MThd")
    return folder


@pytest.fixture
def songs(tmp_path) -> Path:
    return write_songs(tmp_path)


@pytest.fixture(scope="module")
def alone(tmp_path_factory) -> dict[str, bytes]:
    """What becomes of them on this machine."""
    folder = write_songs(tmp_path_factory.mktemp("alone"))
    words = ("render", folder / "in", "-o", folder / "out", *DRY, "--jobs", "1")
    with in_the_place_of_workers():
        assert main([*map(str, words)]) == 1
    return results_in(folder / "out")


# ---------------------------------------------------------------- a real cluster


@pytest.mark.slow
def test_a_worker_that_is_killed_changes_nothing_of_the_results(songs, alone, tmp_path):
    tune(songs / "in" / "0" / "long.mid", 70, seconds=20.0)
    with cluster_in(tmp_path) as processes:
        until(lambda: processes.log.read_text().count("Registered to") == 2, within_s=LONG_S)
        run = start("render", songs / "in", "-o", songs / "out", *DRY, "--dask", processes.file)
        records = songs / "out"
        until(
            lambda: run.poll() is not None or len(list(records.rglob("*.wav.json"))) > 1,
            within_s=LONG_S,
        )
        processes.workers[0].kill()
        _, err = run.communicate(timeout=300)
        assert processes.workers[1].poll() is None
    assert err == "yehu-server: broken.mid: has a damaged header at byte 0\n"
    assert run.returncode == 1
    found = results_in(songs / "out")
    assert len(found.pop("0/long.wav")) > 20 * 44100 * 3
    lines = found.pop("manifest.jsonl").decode().splitlines()
    others = [line for line in lines if "long" not in line]
    assert others == alone.pop("manifest.jsonl").decode().splitlines()
    assert len(lines) == SCORES + 2
    assert found == alone
    assert not list((songs / "out").rglob("*.part"))


def test_a_wrong_call_gets_one_line_and_makes_nothing(songs, refused, monkeypatch):
    monkeypatch.chdir(songs)
    for words, wrong in (
        (("in", "-o", "out", "--dask", "a b"), "is not the address of a scheduler"),
        (("in", "-o", "out", "--dask", "none.json"), "No such file"),
        (("in", "-o", "out", "--dask", "x", "--jobs", "2"), "--jobs is for this machine"),
        (("in/0/0.mid", "-o", "a.wav", "--dask", "x"), "--dask is for a folder"),
    ):
        assert wrong in refused("render", *words)
        assert not (songs / "out").exists()


# ---------------------------------------------------------------- workers that see no folder


class Elsewhere:
    """A cluster on whose machines a folder is not there, or is, as `seen` tells."""

    def __init__(self, folder: Path, *, seen: bool = False) -> None:
        self._folder, self._seen = folder, seen

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def ask(self, question, *arguments):
        return {"tcp://worker": question(*arguments)}

    def perform_all(self, perform, tasks):
        for job, task in enumerate(list(tasks)):
            away = self._folder if self._seen else self._folder.with_name("away")
            self._folder.rename(away)
            try:
                result = perform(task, lambda _done, _total: None)
            finally:
                away.rename(self._folder)
            assert bool(result["made"]) != (self._seen or "error" in result["line"])
            yield Event(job, 1.0, result=result)


@pytest.mark.parametrize("seen", [False, True])
def test_scores_and_sounds_travel_where_workers_do_not_see_them(
    alone, command, monkeypatch, seen, tmp_path
):
    home = write_songs(tmp_path / "home")
    monkeypatch.setattr(
        "yehu_server.rendering.cluster.Cluster", lambda *_: Elsewhere(home, seen=seen)
    )
    code, _, err = command("render", home / "in", "-o", home / "out", *DRY, "--dask", "x")
    assert code == 1
    assert err == "yehu-server: broken.mid: has a damaged header at byte 0\n"
    assert results_in(home / "out") == alone
    code, out, _ = command("render", home / "in", "-o", home / "out", *DRY)
    assert f"0 rendered, {SCORES} up to date, 1 failed" in out


def test_an_answer_that_is_no_result_is_an_error_of_its_score(songs, command, monkeypatch):
    class Strange(Elsewhere):
        def perform_all(self, perform, tasks):
            for event in super().perform_all(perform, tasks):
                good, job = event.result, event.job
                line = good["line"]
                strange = [
                    None,
                    {**good, "line": {**line, "file": "../0.mid"}},
                    {**good, "line": {**line, "duration_s": "\x1b[2J"}},
                    {**good, "line": {**line, "error": b"x"}},
                    {**good, "made": ["text"]},
                    {**good, "made": good["made"] * 2},
                    {**good, "read": 5},
                ]
                yield replace(event, result=strange[job] if job < len(strange) else good)

    monkeypatch.setattr("yehu_server.rendering.cluster.Cluster", lambda *_: Strange(songs / "in"))
    (songs / "in" / "broken.mid").unlink()
    code, _, err = command("render", songs / "in", "-o", songs / "out", *DRY, "--dask", "x")
    assert code == 1
    told = [line.partition(".mid: ")[2] for line in err.splitlines()]
    assert told == ["a worker answered with what is no result"] * (SCORES - 1)
    assert len(list((songs / "out").rglob("*.wav"))) == 1


def test_a_file_of_the_users_own_is_not_replaced_by_what_has_travelled(songs, command, monkeypatch):
    monkeypatch.setattr("yehu_server.rendering.cluster.Cluster", lambda *_: Elsewhere(songs / "in"))
    own = songs / "out" / "0" / "0.wav"
    own.parent.mkdir(parents=True)
    own.write_bytes(b"my own")
    code, _, err = command("render", songs / "in", "-o", songs / "out", *DRY, "--dask", "x")
    assert code == 1
    assert "0/0.mid: exists; --overwrite replaces it" in err.replace(f"{own}: ", "")
    assert own.read_bytes() == b"my own"


def test_settings_that_a_worker_does_not_have_are_named(songs, refused, monkeypatch):
    class Without(Elsewhere):
        def ask(self, question, *arguments):
            answers = super().ask(question, *arguments)
            return {"tcp://worker": dict.fromkeys(answers["tcp://worker"], "")}

    monkeypatch.setattr("yehu_server.rendering.cluster.Cluster", lambda *_: Without(songs / "in"))
    (songs / "i.json").write_text(SETTINGS)
    words = ("render", songs / "in", "-o", songs / "out", *DRY, "--dask", "x")
    line = refused(*words, "--instrument", songs / "i.json")
    assert is_one_line(line)
    assert "i.json: the worker tcp://worker does not have this file" in line


def test_paths_hold_on_other_machines_and_names_stay_names(tmp_path, monkeypatch):
    from yehu_server.cli import _parser
    from yehu_server.cli.folder_cluster import absolute

    monkeypatch.chdir(tmp_path)
    (tmp_path / "m.toml").touch()
    (tmp_path / "wind").touch()

    def given(*words: str):
        return absolute(_parser().parse_args(["render", "in", "-o", "out", *words]))

    found = given("--mapping", "m.toml", "--preset", "a/b.toml", "--tuning", "chaozhou")
    assert (found.midi, found.output) == ([tmp_path / "in"], tmp_path / "out")
    assert found.mapping == str(tmp_path / "m.toml")
    assert found.preset == str(tmp_path / "a" / "b.toml")
    assert (found.tuning, given("--ensemble").ensemble) == (Path("chaozhou"), Path())
    assert given("--mapping", "wind").mapping == "wind"
    assert given("--preset", "mine/x+hall").preset == "mine/x+hall"
