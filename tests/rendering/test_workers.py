"""Jobs on several processes."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
import some_jobs
from waiting import LONG_S, until

from yehu_server.rendering.workers import perform_all

TESTS = Path(__file__).resolve().parents[1]


def ends(perform, tasks, workers=2) -> dict:
    """What became of each task."""
    return {event.job: event for event in perform_all(perform, tasks, workers)}


def test_each_task_is_done_once():
    for workers in (1, 2):
        results = ends(some_jobs.double, [1, 2, 3, 4, 5], workers)
        assert [results[job].result for job in range(5)] == [2, 4, 6, 8, 10]


def test_a_job_that_kills_its_process_takes_no_other_with_it():
    results = ends(some_jobs.fall, [1, -1, 2, -1, 3])
    assert sorted(results) == [0, 1, 2, 3, 4]
    for job in (1, 3):
        assert results[job].died == "killed by signal 9"
    for job in (0, 2, 4):
        assert results[job].died == ""
        assert results[job].result > 0


def test_a_job_is_tried_again_after_its_process_died(tmp_path):
    results = ends(some_jobs.fall, [tmp_path / "tried"], 1)
    assert results[0].died == ""
    assert results[0].result != os.getpid()


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
def test_processes_put_away_what_they_make_when_their_parent_is_killed(tmp_path):
    held = tmp_path / "held"
    program = (
        "import sys; sys.path.insert(0, sys.argv[1]); from pathlib import Path; import some_jobs;"
        "from yehu_server.rendering.workers import perform_all;"
        "list(perform_all(some_jobs.hold, [Path(sys.argv[2])], 1))"
    )
    parent = subprocess.Popen([sys.executable, "-c", program, str(TESTS), str(held)])
    until(held.exists, within_s=LONG_S)
    parent.kill()
    parent.wait()
    until(lambda: not held.exists(), within_s=LONG_S)
