"""The reader of a file is chosen by what the file holds, else by its name."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

import pytest
from musicxml_text import note, score, words

from yehu_server.errors import ScoreError
from yehu_server.scores.reading import is_capture, is_written, read_any, read_written
from yehu_server.scores.score import notes_of
from yehu_server.scores.smf.faults import DamagedError
from yehu_server.scores.smf.reader import read_score

TUNE = Path(__file__).resolve().parents[2] / "examples" / "shi_bei_jiu.mid"
BAR = note("G4", 2) + note("A4", 2)


@pytest.mark.parametrize("name", ["tune.musicxml", "tune.XML", "tune", "tune.score"])
@pytest.mark.parametrize("mark", [b"", b"\xef\xbb\xbf"])
def test_musicxml_is_known_by_its_ending_or_its_beginning(tmp_path, name, mark):
    path = tmp_path / name
    path.write_bytes(mark + score(BAR).encode())
    assert is_written(path)
    assert [each.key for each in notes_of(read_any(path))] == [67, 69]
    assert read_any(path).name == "tune"


@pytest.mark.parametrize("name", ["tune.mid", "tune.kar", "tune", "tune.txt", "tune.xml"])
def test_a_midi_file_is_read_as_before(tmp_path, name):
    path = shutil.copy(TUNE, tmp_path / name)
    assert not is_written(path)
    assert read_any(path).events == read_score(TUNE).events


def test_a_midi_file_has_no_marks_to_show():
    with pytest.raises(ScoreError, match="is no written score"):
        read_written(TUNE)


def test_strict_refuses_marks_that_are_not_understood(tmp_path):
    path = tmp_path / "tune.musicxml"
    path.write_text(score(words("with a smile") + BAR), encoding="utf-8")
    assert "with a smile" in read_any(path).warnings[0]
    with pytest.raises(DamagedError, match=r"tune\.musicxml: not understood"):
        read_any(path, strict=True)


def test_a_score_that_lasts_too_long_is_refused(tmp_path):
    path = tmp_path / "tune.musicxml"
    path.write_text(score(BAR), encoding="utf-8")
    with pytest.raises(ScoreError, match=r"tune\.musicxml: .*hours"):
        read_any(path, max_duration_h=1e-4)
    with pytest.raises(ScoreError, match="1 song"):
        read_any(path, song=2)


def test_a_long_capture_is_known_by_its_first_bytes(tmp_path):
    path = tmp_path / "session.jsonl"
    path.write_bytes(b"{")
    os.truncate(path, 65 << 20)  # more than a text may have; the disk keeps one byte
    assert is_capture(path)


def test_a_score_without_notes_names_its_file(tmp_path):
    path = tmp_path / "silence.musicxml"
    path.write_text(score(note("r", 4)), encoding="utf-8")
    with pytest.raises(ScoreError, match=r"silence\.musicxml: has no note"):
        read_any(path)
