"""examples/mo_li_hua.mid: one tune for four yehus, each in its own ornaments."""

from __future__ import annotations

import subprocess
import sys
from itertools import pairwise
from pathlib import Path

import pytest

from yehu_server.scores.reading import channels_with_notes, part_of
from yehu_server.scores.score import Score, ScoreNote, notes_of
from yehu_server.scores.smf.reader import read_score

ROOT = Path(__file__).resolve().parents[2]
FILE = ROOT / "examples" / "mo_li_hua.mid"
PLAIN, FLOWERS, BONES, OCTAVE = range(4)
SCALE = {10, 0, 2, 5, 7}  # of B flat, without fa and ti


@pytest.fixture(scope="module")
def score() -> Score:
    return read_score(FILE)


@pytest.fixture(scope="module")
def parts(score) -> list[list[ScoreNote]]:
    assert channels_with_notes([score]) == [PLAIN, FLOWERS, BONES, OCTAVE]
    return [notes_of(part_of(score, channel)) for channel in (PLAIN, FLOWERS, BONES, OCTAVE)]


def on_beats(notes: list[ScoreNote]) -> dict[float, int]:
    return {note.beat: note.key for note in notes if note.beat == round(note.beat)}


def test_making_it_again_gives_the_shipped_bytes(tmp_path):
    script = ROOT / "scripts" / "make_examples.py"
    subprocess.run([sys.executable, script, FILE.stem, "-o", tmp_path], check=True)
    assert (tmp_path / FILE.name).read_bytes() == FILE.read_bytes()


def test_all_play_within_the_yehu_in_the_scale_of_the_tune(score, parts):
    assert score.warnings == ()
    for notes in parts:
        assert all(65 <= note.key <= 89 for note in notes)
        assert {note.key % 12 for note in notes} <= SCALE


def test_no_part_has_two_notes_at_a_time_but_for_slurs(parts):
    for notes in parts:
        assert all(note.end_s < after.start_s + 0.02 for note, after in pairwise(notes))


def test_all_have_the_notes_of_the_tune_on_the_beats(parts):
    tune = on_beats(parts[PLAIN])
    for notes in (parts[FLOWERS], parts[BONES], parts[OCTAVE]):
        own = on_beats(notes)
        both = tune.keys() & own.keys()
        assert len(both) > 0.7 * len(own)
        assert all((own[beat] - tune[beat]) % 12 == 0 for beat in both)


def test_one_has_more_notes_than_the_tune_one_fewer_and_one_higher_ones(parts):
    plain, flowers, bones, octave = parts
    assert len(flowers) > 2 * len(plain)
    assert len(bones) < 0.5 * len(plain)
    assert [note.start_s for note in octave] == [note.start_s for note in plain]
    higher = [high.key - note.key for high, note in zip(octave, plain, strict=True)]
    assert set(higher) == {0, 12}
    assert higher.count(12) > len(plain) / 2
