"""A file is read by what it holds, else by its name; what a channel or a track has to play."""

import os
import shutil
from pathlib import Path

import mido
import pytest
from musicxml_text import note, score, words

from yehu_server.errors import ScoreError
from yehu_server.scores.events import Events, ScoreEvent
from yehu_server.scores.reading import (
    channels_with_notes,
    is_capture,
    is_written,
    part_of,
    read_any,
    read_written,
    tracks_with_notes,
)
from yehu_server.scores.score import Score
from yehu_server.scores.smf.reader import read_score
from yehu_server.scores.smf.track import DamagedError

TUNE = Path(__file__).resolve().parents[2] / "examples" / "shi_bei_jiu.mid"
BAR = note("G4", 2) + note("A4", 2)


def test_musicxml_is_known_by_its_ending_or_its_beginning(tmp_path):
    for name in ("tune.musicxml", "tune.XML", "tune", "tune.score"):
        for mark in (b"", b"\xef\xbb\xbf"):
            path = tmp_path / name
            path.write_bytes(mark + score(BAR).encode())
            assert is_written(path), (name, mark)
            assert [each.key for each in read_any(path).notes] == [67, 69]
            assert read_any(path).name == "tune"


def test_abc_is_known_by_its_beginning_whatever_its_ending(tmp_path):
    for before in ("", "\ufeff", "% from a page\n\n", "%abc-2.1\n"):
        for name in ("tune.txt", "tune"):
            path = tmp_path / name
            path.write_text(f"{before}X:1\nT:A tune\nL:1/4\nK:C\nGA|\n", "utf-8")
            assert [each.key for each in read_any(path).notes] == [67, 69], (name, before)


def test_a_midi_file_of_any_name_is_read_as_before_and_has_no_marks_to_show(tmp_path):
    for name in ("tune.mid", "tune.kar", "tune", "tune.txt", "tune.xml"):
        path = shutil.copy(TUNE, tmp_path / name)
        assert not is_written(path), name
        assert read_any(path).events == read_score(TUNE).events, name
    with pytest.raises(ScoreError, match="is not a written score"):
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


# ---------------------------------------------------------------- parts


def on(channel: int, track: int, note: int = 70) -> ScoreEvent:
    return ScoreEvent(0.0, mido.Message("note_on", channel=channel, note=note), 0.0, track)


def control(channel: int, track: int) -> ScoreEvent:
    return ScoreEvent(0.0, mido.Message("control_change", channel=channel, control=1), 0.0, track)


RESET = ScoreEvent(0.5, mido.Message("reset"))
EVENTS = (control(0, 1), control(3, 1), on(0, 2), on(1, 2), on(0, 3), on(9, 4), RESET)
SCORE = Score(Events.of(EVENTS), 1.0)


def test_channels_and_tracks_with_notes_are_found():
    assert channels_with_notes([SCORE]) == [0, 1, 9]
    assert tracks_with_notes([SCORE]) == [2, 3]


def test_a_part_has_its_events_and_what_moves_all_and_is_as_long_as_its_score():
    """A track also has the controllers of its channels from tracks without notes."""
    for which, events in [
        ({"channel": 0}, (control(0, 1), on(0, 2), on(0, 3), RESET)),
        ({"track": 2}, (control(0, 1), on(0, 2), on(1, 2), RESET)),
        ({"track": 4}, (on(9, 4), RESET)),
        ({"channel": 1, "track": 2}, (on(1, 2), RESET)),
        ({"channel": 7}, (RESET,)),
    ]:
        part = part_of(SCORE, **which)
        assert [*map(str, part.events)] == [*map(str, events)], which
        assert part.duration_s == SCORE.duration_s
