"""The scores shipped in examples/."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from yehu_server.scores.reading import read_written
from yehu_server.scores.score import Score
from yehu_server.scores.smf.reader import read_score

ROOT = Path(__file__).resolve().parents[2]
TUNE = ROOT / "examples" / "shi_bei_jiu.mid"


@pytest.fixture(scope="module")
def tune() -> Score:
    return read_score(TUNE)


def messages(score: Score, kind: str) -> list:
    return [event.message for event in score.events if event.message.type == kind]


def test_making_shi_bei_jiu_again_gives_the_shipped_bytes(tmp_path):
    script = ROOT / "scripts" / "make_examples.py"
    subprocess.run([sys.executable, script, TUNE.stem, "-o", tmp_path], check=True)
    assert (tmp_path / TUNE.name).read_bytes() == TUNE.read_bytes()


def test_shi_bei_jiu_stays_within_the_yehu(tune):
    notes = messages(tune, "note_on")
    assert all(65 <= message.note <= 89 for message in notes)
    assert all(50 <= message.velocity <= 105 for message in notes)
    assert {event.message.channel for event in tune.events} == {0}
    assert tune.warnings == ()


def test_every_note_of_shi_bei_jiu_ends_and_never_starts_twice(tune):
    sounding: set[int] = set()
    for event in tune.events:
        match event.message.type:
            case "note_on":
                assert event.message.note not in sounding
                sounding.add(event.message.note)
                assert len(sounding) <= 2  # a slur overlaps two notes, never three
            case "note_off":
                sounding.remove(event.message.note)
    assert not sounding


def test_shi_bei_jiu_ends_on_a_long_note_with_everything_at_rest(tune):
    last_on = [event for event in tune.events if event.message.type == "note_on"][-1]
    assert tune.duration_s - last_on.time_s > 1.5
    assert messages(tune, "pitchwheel")[-1].pitch == 0
    assert messages(tune, "aftertouch")[-1].value == 0
    # 200 slots of 0.125 s, the last bars a little slower, and the last note
    assert 26.0 < tune.duration_s < 29.0


def test_the_bends_of_shi_bei_jiu_are_small(tune):
    # within two semitones either way: a semitone is 4096
    bends = [message.pitch for message in messages(tune, "pitchwheel")]
    assert min(bends) == -2048
    assert max(bends) <= 0.15 * 4096 + 1


def test_every_phrase_is_understood_and_lies_within_the_yehu():
    wrong = []
    phrases = sorted((ROOT / "examples" / "phrases").glob("*.jianpu"))
    assert len(phrases) == 12
    for path in phrases:
        written = read_written(path)
        if written.warnings or written.not_understood:
            wrong.append((path.stem, written.warnings, written.not_understood))
        if not all(65.0 <= note.pitch <= 89.0 for part in written.parts for note in part.notes):
            wrong.append((path.stem, "range"))
    assert wrong == []
