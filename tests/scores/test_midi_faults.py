"""Every fault of MIDI files: what becomes of it, what is said, and where mido agrees."""

from __future__ import annotations

import re
from pathlib import Path

import mido
import pytest
from midi_faults import AGREES, CASES, DIFFERS, REFUSES, UNASKED, Case
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


# ---------------------------------------------------------------- another reader


def by_mido(path: Path) -> list[list[tuple[float, list[int]]]]:
    """The channel messages of each song with their times, by mido."""
    file = mido.MidiFile(path)
    songs = [[track] for track in file.tracks] if file.type == 2 else [file.tracks]
    theirs = []
    for tracks in songs:
        now, messages = 0.0, []
        for message in mido.MidiFile(type=1, ticks_per_beat=file.ticks_per_beat, tracks=tracks):
            now += message.time
            if hasattr(message, "channel"):
                messages.append((now, message.bytes()))
        theirs.append(messages)
    return theirs


def by_us(path: Path, songs: int) -> list[list[tuple[float, list[int]]]]:
    scores = [read_score(path, song=song + 1, max_duration_h=1000.0) for song in range(songs)]
    return [
        [(pytest.approx(event.time_s), event.message.bytes()) for event in score.events]
        for score in scores
    ]


def made_by_mido(case: Case, path: Path) -> str:
    try:
        theirs = by_mido(path)
    except Exception:  # noqa: BLE001 - of any kind: mido has no errors of its own
        return REFUSES
    try:
        ours = by_us(path, len(theirs))
    except ScoreError:
        return AGREES if not any(theirs) else DIFFERS
    if case.hears is not None and len(case.hears) > sum(map(begun, ours)):
        return DIFFERS  # the rest is in songs that mido has not found
    return AGREES if theirs == ours else DIFFERS


def begun(messages: list[tuple[float, list[int]]]) -> int:
    return sum(0x90 <= status < 0xA0 and velocity > 0 for _, (status, _, velocity) in messages)


def test_mido_agrees_message_for_message_where_it_is_said_to(subtests, written):
    for case in [case for case in CASES if case.mido != UNASKED]:
        with subtests.test(case=case):
            assert made_by_mido(case, written(case.data)) == case.mido
