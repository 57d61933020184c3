"""``yehu-server render FOLDER --dask``: a folder on a cluster of workers."""

import contextlib
import math
from dataclasses import replace
from pathlib import Path
from typing import Self

import pytest
from clusters import cluster_in, needs_distributed
from commands import results_in
from forks import in_the_place_of_workers, start
from midi_files import midi_file, notes
from waiting import LONG_S, until

from yehu_server.cli import main
from yehu_server.rendering import cluster_worker
from yehu_server.rendering.workers import Event

pytestmark = needs_distributed

DRY = ("--dry", "--mono", "--tail", "0")
SCORES = 8


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
        (("in", "-o", "out", "--dask", "none.json"), "no such file"),
        (("in", "-o", "out", "--dask", "x", "--jobs", "2"), "--jobs is for this machine"),
        (("in/0/0.mid", "-o", "a.wav", "--dask", "x"), "--dask is for a folder"),
    ):
        assert wrong in refused("render", *words)
        assert not (songs / "out").exists()


# ---------------------------------------------------------------- a cluster that is none


class Here:
    """A cluster whose workers are this process, in another folder."""

    def __init__(self, elsewhere: Path) -> None:
        self._elsewhere = elsewhere

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def perform_all(self, perform, tasks):
        for job, task in enumerate(tasks):
            with contextlib.chdir(self._elsewhere):
                result = perform(task)
            yield Event(job, result=result)


@pytest.fixture
def rendered(songs, command, monkeypatch, tmp_path_factory):
    """Render the songs, named from within their folder, on a cluster of a class."""
    monkeypatch.chdir(songs)
    elsewhere = tmp_path_factory.mktemp("elsewhere")

    def run(kind: type[Here]) -> tuple[int, str, str]:
        monkeypatch.setattr("yehu_server.rendering.cluster.Cluster", lambda *_: kind(elsewhere))
        return command("render", "in", "-o", "out", *DRY, "--dask", "x")

    return run


def test_workers_that_do_not_see_the_output_are_reported(songs, rendered):
    class Away(Here):
        def perform_all(self, perform, tasks):
            tasks = list(tasks)
            for mark in (songs / "out" / ".yehu-server").glob("seen-*"):
                mark.unlink()
            yield from super().perform_all(perform, tasks)

    code, _, err = rendered(Away)
    assert code == 1
    told = [line.partition(".mid: ")[2] for line in err.splitlines()]
    expected = "a worker does not see the output; keep it where all see it"
    assert told == [expected] * (SCORES + 1)
    assert not list((songs / "out").rglob("*.wav"))


def test_an_answer_that_is_no_result_is_an_error_of_its_score(songs, rendered):
    class Strange(Here):
        def perform_all(self, perform, tasks):
            for event in super().perform_all(perform, tasks):
                line = event.result
                strange = [
                    None,
                    {**line, "file": "../0.mid"},
                    {**line, "duration_s": "\x1b[2J"},
                    {**line, "error": b"x"},
                    {"file": line["file"]},
                    {**line, "peak": math.nan},
                ]
                job = event.job
                yield replace(event, result=strange[job] if job < len(strange) else line)

    (songs / "in" / "broken.mid").unlink()
    code, _, err = rendered(Strange)
    assert code == 1
    told = [line.partition(".mid: ")[2] for line in err.splitlines()]
    assert told == ["a worker's answer is not a result"] * 6
