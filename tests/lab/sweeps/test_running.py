"""Studies that are run: the same bits in any way, and again after an interruption."""

from __future__ import annotations

import json

import numpy as np
import pytest

from yehu_server.errors import OutputError, YehuError
from yehu_server.lab.regimes.columns import HELMHOLTZ
from yehu_server.lab.sweeps import running
from yehu_server.lab.sweeps.journal import Journal, journal_of
from yehu_server.lab.sweeps.running import findings_of, perform, sweep, sweep_to
from yehu_server.lab.sweeps.study import study_of
from yehu_server.rendering.workers import Event


@pytest.fixture
def small_chunks(monkeypatch):
    monkeypatch.setattr(running, "CHUNK", 5)


@pytest.mark.usefixtures("small_chunks")
def test_a_study_makes_the_same_file_with_any_number_of_workers(tmp_path, data, result):
    for workers in (1, 3):
        sweep_to(study_of(data()), tmp_path / f"{workers}.npz", workers=workers)
    result.save(tmp_path / "memory.npz")
    files = [(tmp_path / f"{name}.npz").read_bytes() for name in ("1", "3", "memory")]
    assert files[0] == files[1] == files[2]
    assert not list(tmp_path.glob("*.part"))


def test_all_points_of_the_coarse_grid_are_computed(result):
    coarse = result.index[(result.index % 2 == 0).all(axis=1)]
    assert len(coarse) == 5 * 3
    assert 15 < len(result) <= 9 * 5


@pytest.mark.usefixtures("small_chunks")
@pytest.mark.parametrize("stop", [1, 3])
def test_an_interrupted_study_goes_on_and_ends_the_same(tmp_path, data, result, stop, monkeypatch):
    study, target = study_of(data()), tmp_path / "mine.npz"

    def interrupt(done, _total):
        if done >= 5 * stop:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt, match="the same command goes on"):
        sweep_to(study, target, workers=1, progress=interrupt)
    assert not target.exists()
    # As a crash leaves it: the last block is cut off.
    with journal_of(target).open("ab") as file:
        file.write(b"\x05\x00\x00\x00cut off")
    computed = []
    monkeypatch.setattr(
        running, "findings_of", lambda *given: computed.append(given[1]) or findings_of(*given)
    )
    sweep_to(study, target, workers=1)
    assert sum(map(len, computed)) <= len(result) - 5 * stop
    result.save(tmp_path / "whole.npz")
    assert target.read_bytes() == (tmp_path / "whole.npz").read_bytes()
    assert not journal_of(target).exists()


@pytest.mark.usefixtures("small_chunks")
def test_a_study_that_was_stopped_within_its_finest_level_ends_the_same(tmp_path, data):
    """What is done of a level must not change which points it wants."""
    refine = {"axes": ["force", "position"], "levels": 2}
    study, target = study_of(data(refine=refine)), tmp_path / "mine.npz"
    whole = sweep(study, workers=2)

    def interrupt(done, _total):
        if done >= len(whole) - 40:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        sweep_to(study, target, workers=1, progress=interrupt)
    found = sweep_to(study, target, workers=1)
    assert np.array_equal(found.numbers, whole.numbers)


@pytest.mark.usefixtures("small_chunks")
def test_a_damaged_journal_loses_only_what_is_damaged(tmp_path, data, result):
    study, target = study_of(data()), tmp_path / "mine.npz"

    def interrupt(done, _total):
        if done >= 10:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        sweep_to(study, target, workers=1, progress=interrupt)
    content = bytearray(journal_of(target).read_bytes())
    content[-3] ^= 0xFF
    journal_of(target).write_bytes(content)
    found = sweep_to(study, target, workers=1)
    for name, column in result.columns.items():
        assert found.columns[name].tobytes() == column.tobytes()


def test_a_journal_of_another_study_is_kept(tmp_path, data):
    target = tmp_path / "mine.npz"
    journal_of(target).write_bytes(json.dumps({"key": "another"}).encode() + b"\n")
    with pytest.raises(OutputError, match="another study"):
        sweep_to(study_of(data()), target)
    journal_of(target).write_text("my notes")
    with pytest.raises(OutputError, match="is not the journal of a sweep"):
        sweep_to(study_of(data()), target)
    assert journal_of(target).read_text() == "my notes"


def test_a_journal_whose_beginning_a_full_disk_cut_off_begins_anew(tmp_path, data, result):
    study, target = study_of(data()), tmp_path / "mine.npz"
    Journal(target, study).close()
    begun = journal_of(target).read_bytes()
    for size in (0, 1, len(begun) - 1):
        journal_of(target).write_bytes(begun[:size])
        found = sweep_to(study, target, overwrite=False)
        assert found.numbers.tobytes() == result.numbers.tobytes()
        target.unlink()


def test_a_result_is_replaced_only_where_it_may_be(tmp_path, data):
    target = tmp_path / "mine.npz"
    target.write_text("mine")
    with pytest.raises(OutputError, match="exists"):
        sweep_to(study_of(data()), target)
    assert target.read_text() == "mine"
    with pytest.raises(OutputError, match=r"ends in \.npz"):
        sweep_to(study_of(data()), tmp_path / "mine.csv")


def test_a_task_of_a_cluster_finds_what_a_thread_finds(data):
    study = study_of(data())
    numbers = np.array([3, 17, 22])
    findings = np.frombuffer(
        perform((study.as_text(), numbers.tobytes())), findings_of(study, numbers).dtype
    )
    for name in findings.dtype.names:
        assert findings[name].tobytes() == findings_of(study, numbers)[name].tobytes()


def test_a_task_that_is_wrong_tells_in_a_line(data):
    text = study_of(data()).as_text().replace('"note": 72', '"note": 12')
    told = perform((text, np.zeros(1, np.int64).tobytes()))
    assert isinstance(told, str)
    assert "note: 12" in told


@pytest.mark.parametrize("strange", [None, b"", b"\xff" * 10**4, [1], 5])
def test_what_a_stranger_answers_is_no_finding(data, strange):
    class Strange:
        def perform_all(self, _perform, _tasks):
            yield Event(0, 1.0, result=strange)

    with pytest.raises(YehuError, match="a worker answered with what are no findings"):
        sweep(study_of(data()), cluster=Strange())


class Dying:
    """A cluster all of whose workers die."""

    def perform_all(self, _perform, tasks):
        from types import SimpleNamespace

        next(iter(tasks))
        yield SimpleNamespace(is_end=False)
        yield SimpleNamespace(is_end=True, died="4 workers", job=0, result=None)


def test_workers_that_die_are_told(data):
    with pytest.raises(YehuError, match="4 workers"):
        sweep(study_of(data()), cluster=Dying())


def test_only_the_border_of_helmholtz_motion_is_refined_where_asked(data, result):
    refine = {"axes": ["force", "position"], "levels": 1, "border": "helmholtz"}
    other = sweep(study_of(data(refine=refine)), workers=2)
    coarse = (other.index % 2 == 0).all(axis=1)
    between = other.columns["regime"][coarse]
    assert len(set((between == HELMHOLTZ).tolist())) == 2
    assert coarse.sum() < len(other) <= len(result)
    assert set(other.numbers) <= set(result.numbers)
