"""The time that is left of a folder: seconds of sound, as far as they are known."""

import pytest

from yehu_server.cli.folder_runs import ProgressEstimate


def share(seconds: ProgressEstimate) -> float:
    return seconds.done / seconds.total


def test_files_of_unknown_length_count_alike():
    seconds = ProgressEstimate([0.0] * 4)
    seconds.update(0, 0.5)
    assert share(seconds) == pytest.approx(0.5 / 4)
    seconds.update(0, 1.0)
    assert share(seconds) == pytest.approx(1 / 4)


def test_a_long_file_counts_for_more_than_a_short_one():
    seconds = ProgressEstimate([1.0, 9.0])
    seconds.update(0, 1.0, 1.0)
    assert (seconds.done, seconds.total) == (1.0, 10.0)
    seconds.update(1, 0.5)
    assert seconds.done == pytest.approx(5.5)


def test_the_length_of_a_file_that_has_begun_replaces_a_guess():
    seconds = ProgressEstimate([2.0, 0.0, 0.0])
    assert seconds.total == 6.0
    seconds.update(1, 0.1, 10.0)
    assert (seconds.done, seconds.total) == pytest.approx((1.0, 18.0))
    seconds.update(1, 1.0, 12.0)
    assert (seconds.done, seconds.total) == pytest.approx((12.0, 21.0))


def test_all_that_failed_is_done_too():
    seconds = ProgressEstimate([5.0, 0.0])
    seconds.update(0, 1.0)
    seconds.update(1, 1.0)
    assert share(seconds) == pytest.approx(1.0)
