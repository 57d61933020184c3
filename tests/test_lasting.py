"""Threads survive errors of the system, and notice when it slept."""

import errno
import os
import threading

import pytest

from yehu_server.util import retry
from yehu_server.util.files import error_reason
from yehu_server.util.retry import LONGEST_GAP_S, AwakeTime, Backoff, run_forever

TOO_MANY = OSError(errno.EMFILE, os.strerror(errno.EMFILE), "/somewhere")


def test_the_wait_after_failures_becomes_longer_up_to_a_bound_and_begins_anew():
    backoff = Backoff(1.0, 5.0)
    assert [backoff.failed() for _ in range(5)] == [1.0, 2.0, 4.0, 5.0, 5.0]
    backoff.worked()
    assert backoff.failed() == 1.0


def test_a_reason_is_news_once():
    backoff = Backoff()
    assert [backoff.is_news(reason) for reason in ("a", "a", "b", "b", "a")] == [1, 0, 1, 0, 1]
    backoff.worked()
    assert backoff.is_news("a")


class Work:
    """Work that raises these errors in turn, and then ends."""

    def __init__(self, monkeypatch, *errors: BaseException | None) -> None:
        monkeypatch.setattr(Backoff, "failed", lambda _backoff: 0.0)
        self.ending = threading.Event()
        self.turns = 0
        self.said: list[str] = []
        self._errors = list(errors)

    def turn(self) -> None:
        self.turns += 1
        if not self._errors:
            self.ending.set()
            return
        error = self._errors.pop(0)
        if error is not None:
            raise error

    def report(self, line: str) -> None:
        self.said.append(line)


@pytest.mark.parametrize(
    "error", [TOO_MANY, MemoryError(), RuntimeError("can't start new thread"), KeyError("defect")]
)
def test_work_outlasts_errors_and_says_so_once_until_all_was_well(monkeypatch, error):
    work = Work(monkeypatch, None, error, error, error, None, error)
    run_forever(work.turn, work.ending, 0.0, "work", work.report)
    assert work.turns == 7
    assert work.said == [f"work: {error_reason(error)}; trying again"] * 2


def test_work_outlasts_that_no_error_can_be_reported(monkeypatch):
    def fail(_line: str) -> None:
        raise MemoryError

    work = Work(monkeypatch, TOO_MANY, TOO_MANY)
    run_forever(work.turn, work.ending, 0.0, "work", fail)
    assert work.turns == 3


def test_what_is_longer_between_two_questions_was_sleep(monkeypatch):
    now = 100.0
    monkeypatch.setattr(retry.time, "monotonic", lambda: now)
    awake = AwakeTime()
    before = awake()
    for _ in range(10):
        now += 0.05
        awake()
    assert awake() - before == pytest.approx(0.5)
    now += 3600.0
    assert awake() - before == pytest.approx(0.5 + LONGEST_GAP_S)
