"""`pytest --changed` selects the tests that a change can reach, nearest first."""

from __future__ import annotations

from changed import FOLDERS, ROOT, distances

TESTS = ROOT / "tests"
SCALE = TESTS / "scores" / "test_jianpu.py"
PHYSICS = TESTS / "core" / "physics" / "test_energy.py"
PAGE = TESTS / "live" / "page" / "test_page_views.py"
ALL = [SCALE, PHYSICS, PAGE]


def test_a_module_reaches_the_tests_that_import_it_and_no_others():
    near = distances({"yehu_server/scores/jianpu/scale.py"}, ALL)
    assert SCALE in near
    assert PHYSICS not in near


def test_what_imports_a_module_directly_is_nearer_than_what_does_so_by_others():
    physics = distances({"yehu_server/core/physics/energy.py"}, ALL)
    assert physics[PHYSICS] < physics[PAGE]


def test_a_changed_test_is_the_nearest_and_its_helpers_count_as_it():
    assert distances({"tests/core/physics/test_energy.py"}, ALL) == {PHYSICS: 0}
    assert distances({"tests/live/page/browser.py"}, ALL) == {PAGE: 0}


def test_files_that_are_no_modules_reach_the_tests_of_their_folder():
    assert distances({"web/main.js"}, ALL) == {PAGE: 1}
    assert distances({"LICENSE"}, ALL) == {}
    assert all((ROOT / place).exists() for places in FOLDERS.values() for place in places)


def test_what_a_process_of_its_own_runs_reaches_those_who_start_it():
    stream = TESTS / "live" / "real_time" / "test_stream.py"
    assert stream in distances({"yehu_server/live/audio/stream.py"}, [stream])
