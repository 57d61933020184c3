"""Which scores a folder has, and where they are rendered to."""

import errno
import os
from pathlib import Path

import pytest

from yehu_server.rendering.folder_tree import tree_of


@pytest.fixture
def made(tmp_path):
    """Make empty files in a folder; what becomes of them, by their names."""

    def make(*names: str) -> dict[str, str]:
        for name in names:
            path = tmp_path / "in" / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.touch()
        found = tree_of(tmp_path / "in", tmp_path / "out", ".wav")
        places = {entry.name: entry.target for entry in found.entries}
        return {name: os.path.relpath(target, tmp_path / "out") for name, target in places.items()}

    return make


def test_the_tree_is_kept(made):
    found = made("a.mid", "x/b.MIDI", "x/y z/c.kar", "x/readme.txt", "d.wav")
    assert found == {"a.mid": "a.wav", "x/b.MIDI": "x/b.wav", "x/y z/c.kar": "x/y z/c.wav"}


def test_hidden_files_and_folders_are_left_out(made):
    assert made("._a.mid", ".trash/b.mid", "c.mid") == {"c.mid": "c.wav"}


def test_scores_that_differ_in_their_endings_go_to_files_of_their_own(made):
    found = made("a.mid", "a.MID", "a.kar", "A.mid")
    assert found["A.mid"] == "A.wav"
    assert found["a.mid"] == "a.mid.wav"
    assert found["a.kar"] == "a.kar.wav"
    targets = [target.casefold() for name, target in found.items()]
    assert len(set(targets)) == len(targets)


def test_a_new_file_beside_a_score_does_not_move_its_result(made):
    before = made("b.mid", "c.mid")
    after = made("b.kar", "c.MID", "c.rmi")
    assert {name: after[name] for name in before} == before


def test_an_output_within_the_input_is_not_read(tmp_path):
    inner = tmp_path / "out"
    inner.mkdir()
    (inner / "a.mid").touch()
    (tmp_path / "b.mid").touch()
    assert [entry.name for entry in tree_of(tmp_path, inner, ".wav").entries] == ["b.mid"]
    both = tree_of(tmp_path, tmp_path, ".wav").entries
    assert [entry.name for entry in both] == ["b.mid", "out/a.mid"]


def test_links_are_followed_but_no_folder_is_looked_into_twice(tmp_path):
    (tmp_path / "in" / "x").mkdir(parents=True)
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "elsewhere" / "a.mid").touch()
    (tmp_path / "in" / "there").symlink_to(tmp_path / "elsewhere")
    (tmp_path / "in" / "x" / "round").symlink_to(tmp_path / "in")
    (tmp_path / "in" / "self.mid").symlink_to("self.mid")
    found = tree_of(tmp_path / "in", tmp_path / "out", ".wav")
    assert [entry.name for entry in found.entries] == ["self.mid", "there/a.mid"]
    assert found.problems == ()


def test_a_folder_that_cannot_be_read_is_a_problem(tmp_path, made, monkeypatch):
    made("a.mid", "x/b.mid")
    scandir = os.scandir

    def denied(path):
        if Path(path).name == "x":
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), path)
        return scandir(path)

    monkeypatch.setattr(os, "scandir", denied)
    found = tree_of(tmp_path / "in", tmp_path / "out", ".wav")
    assert [entry.name for entry in found.entries] == ["a.mid"]
    assert found.problems == (("x", "permission denied"),)
