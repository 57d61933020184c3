"""Every fault of MIDI files: what becomes of it, and what is said."""

import re
from pathlib import Path

import pytest
from midi_faults import CASES, Case
from pages import page

from yehu_server.errors import ScoreError
from yehu_server.scores.score import Score
from yehu_server.scores.smf.reader import read_score
from yehu_server.scores.smf.track import DamagedError

LONG = 1_000_000  # bytes
PAGE = "docs/midi_files.md"
ROW = re.compile(r"^\| `([a-z0-9-]+)` \| (?:.+?) \| (.*?) \|$", re.MULTILINE)


@pytest.fixture
def written(tmp_path):
    def to_file(data: bytes) -> Path:
        path = tmp_path / "tune.mid"
        path.write_bytes(data)
        return path

    return to_file


def notes_of(score: Score) -> tuple[tuple[float, int], ...]:
    return tuple(
        (pytest.approx(event.time_s), event.message.note)
        for event in score.events
        if event.message.type == "note_on" and event.message.velocity > 0
    )


@pytest.mark.parametrize(
    "case",
    [
        pytest.param(case, marks=[pytest.mark.slow] if len(case.data) > LONG else [], id=case.name)
        for case in CASES
    ],
)
def test_a_fault_has_the_outcome_that_is_written_of_it(case: Case, written):
    """Strict refuses what is warned of, at the first place, and nothing else."""
    path = written(case.data)
    places = [int(at) for at in re.findall(r"at byte (\d+)", case.says)]
    assert all(at <= len(case.data) for at in places)
    if case.hears is None:
        with pytest.raises(ScoreError) as refusal:
            read_score(path)
        assert str(refusal.value) == f"{path}: {case.says}"
        return
    score = read_score(path)
    assert case.hears == notes_of(score)
    assert "; ".join(score.warnings) == case.says
    if not case.says:
        assert case.hears == notes_of(read_score(path, strict=True))
        return
    with pytest.raises(DamagedError) as refusal:
        read_score(path, strict=True)
    words = rf"{re.escape(str(path))}: .*, at byte {min(places)}: refused by --strict"
    assert re.fullmatch(words, str(refusal.value))


def test_the_page_has_what_is_said_of_each_fault():
    rows = dict(ROW.findall(page(PAGE).text))
    assert rows == {case.name: f"`{case.says}`" if case.says else "nothing" for case in CASES}
