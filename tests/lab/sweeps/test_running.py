"""Studies that are run: the same bits in any way, and again after an interruption."""

import json
from types import SimpleNamespace

import numpy as np
import pytest

from yehu_lab.regimes.columns import HELMHOLTZ
from yehu_lab.sweeps import running
from yehu_lab.sweeps.journal import journal_of
from yehu_lab.sweeps.running import findings_of, perform, sweep, sweep_to
from yehu_lab.sweeps.study import study_of
from yehu_server.errors import OutputError, YehuError
from yehu_server.playing.calibration_store import calibration_for
from yehu_server.rendering.workers import Event


@pytest.fixture
def _small_chunks(monkeypatch):
    monkeypatch.setattr(running, "CHUNK", 5)


def interrupted(study, target, done):
    """Run a study to a file until so many strokes are done."""

    def interrupt(now, _total):
        if now >= done:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt, match=r"^\d+ of .*\d+ strokes are in"):
        sweep_to(study, target, workers=1, progress=interrupt)
    assert not target.exists()


@pytest.mark.usefixtures("_small_chunks")
def test_a_study_makes_the_same_file_with_any_number_of_workers(tmp_path, data, result):
    for workers in (1, 3):
        sweep_to(study_of(data()), tmp_path / f"{workers}.npz", workers=workers)
    result.save(tmp_path / "memory.npz")
    files = [(tmp_path / f"{name}.npz").read_bytes() for name in ("1", "3", "memory")]
    assert files[0] == files[1] == files[2]
    assert not list(tmp_path.glob("*.part"))


@pytest.mark.usefixtures("_small_chunks")
def test_an_interrupted_study_goes_on_and_ends_the_same(tmp_path, data, result, monkeypatch):
    """With what was done, though a crash cut the last block off, or a disk spoilt it."""
    study, target = study_of(data()), tmp_path / "mine.npz"
    result.save(tmp_path / "whole.npz")
    journal = journal_of(target)
    for stop, damage, kept in (
        (1, lambda whole: whole + b"\x05\x00\x00\x00cut off", 5),
        (3, lambda whole: whole[:-3] + bytes([whole[-3] ^ 0xFF]) + whole[-2:], 10),
    ):
        interrupted(study, target, 5 * stop)
        journal.write_bytes(damage(journal.read_bytes()))
        computed = []

        def counted(*given, computed=computed):
            computed.extend(given[1])
            return findings_of(*given)

        with monkeypatch.context() as patch:
            patch.setattr(running, "findings_of", counted)
            sweep_to(study, target, workers=1)
        assert len(computed) <= len(result) - kept
        assert target.read_bytes() == (tmp_path / "whole.npz").read_bytes()
        assert not journal.exists()
        target.unlink()


def test_a_journal_of_another_study_is_kept(tmp_path, data):
    target = tmp_path / "mine.npz"
    journal_of(target).write_bytes(json.dumps({"key": "another"}).encode() + b"\n")
    with pytest.raises(OutputError, match="another study"):
        sweep_to(study_of(data()), target)
    journal_of(target).write_text("my notes")
    with pytest.raises(OutputError, match="is not the journal of a sweep"):
        sweep_to(study_of(data()), target)
    assert journal_of(target).read_text() == "my notes"


def test_a_tension_is_a_share_of_what_the_string_is_tuned_to(data):
    shares, tuned = [0.9, 1.1], calibration_for(44100.0).tensions[0]
    found = [
        sweep(study_of(data(vary={name: values}, refine={}))).arrays()
        for name, values in (
            ("tension", shares),
            ("instrument.string_1.T", [share * tuned for share in shares]),
        )
    ]
    for name in ("regime", "level_db"):
        np.testing.assert_array_equal(found[0][name], found[1][name])


def test_a_task_of_a_cluster_finds_what_a_thread_finds_or_tells_what_is_wrong(data):
    study, numbers = study_of(data()), np.array([3, 17, 22])
    expected = findings_of(study, numbers)
    found = np.frombuffer(perform((study.as_text(), numbers.tobytes())), expected.dtype)
    assert found.tobytes() == expected.tobytes()
    text = study.as_text().replace('"note": 72', '"note": 12')
    assert "note: 12" in perform((text, numbers.tobytes()))


def test_what_a_stranger_answers_is_no_finding_and_workers_that_die_are_reported(data, result):
    def answers(answer):
        """A cluster that answers a task with something made of what this machine finds."""

        def perform_all(perform, tasks):
            for job, task in enumerate(tasks):
                yield Event(job, result=answer(perform(task)))

        return SimpleNamespace(perform_all=perform_all)

    dead = SimpleNamespace(died="4 workers", job=0, result=None)
    no_findings = "a worker's answer is not a result"
    for cluster, told in (
        *((answers(lambda _, each=each: each), no_findings) for each in (None, b"", [1], 5)),
        (answers(lambda found: found + found[:1]), no_findings),
        (answers(lambda found: b"\xff" * len(found)), no_findings),  # regimes that there are not
        (answers(lambda _: "no room"), "no room"),
        (SimpleNamespace(perform_all=lambda *_: iter([dead])), "4 workers"),
    ):
        with pytest.raises(YehuError, match=told):
            sweep(study_of(data()), cluster=cluster)
    found = sweep(study_of(data()), cluster=answers(lambda found: found))
    assert found.arrays()["regime"].tobytes() == result.arrays()["regime"].tobytes()


def test_all_of_the_coarse_grid_is_computed_and_asked_only_the_border_of_helmholtz_motion_refined(
    data, result
):
    refine = {"axes": ["force", "position"], "levels": 1, "border": "helmholtz"}
    other = sweep(study_of(data(refine=refine)), workers=2)
    for found in (result, other):
        coarse = (found.index % 2 == 0).all(axis=1)
        assert 5 * 3 == coarse.sum() < len(found) <= 9 * 5
    between = other.columns["regime"][coarse]
    assert len(set((between == HELMHOLTZ).tolist())) == 2
    assert set(other.numbers) <= set(result.numbers)
