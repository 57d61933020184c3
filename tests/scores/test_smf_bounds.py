"""The reader of MIDI files: what it refuses, files cut short, bounds, and scores in a row."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import mido
import pytest
from midi_bytes import END, chunk, midi, off, on, tempo
from midi_reading import read_file, told

from yehu_server.errors import ScoreError
from yehu_server.scores.score import Score, ScoreEvent, concatenate
from yehu_server.scores.smf import chunks as smf_chunks
from yehu_server.scores.smf.reader import read_score


@pytest.fixture
def read(tmp_path: Path) -> Callable[[bytes], Score]:
    return lambda data: read_file(tmp_path, data)


# ---------------------------------------------------------------- refusals

NO_HEADER = "is not a MIDI file: there is no header (MThd) in the first 64 kB"


@pytest.mark.parametrize(
    ("data", "reason"),
    [
        (b"Dear player, here is the tune: la la la.\n", NO_HEADER),
        (b"RIFF\x24\0\0\0RMIDLIST\x00\0\0\0", NO_HEADER),
        (b"MThd", "has a damaged header at byte 0"),
        (midi(b""), "has no playable track"),
    ],
)
def test_what_is_not_a_tune_is_refused_in_one_line(read, tmp_path, data, reason):
    with pytest.raises(ScoreError) as refusal:
        read(data)
    assert str(refusal.value) == f"{tmp_path / 'tune.mid'}: {reason}"


def test_a_missing_file_and_a_folder_are_refused_by_name(tmp_path):
    with pytest.raises(ScoreError, match=r"gone\.mid: cannot be read \(no such file"):
        read_score(tmp_path / "gone.mid")
    with pytest.raises(ScoreError, match=r"cannot be read \(is a directory\)"):
        read_score(str(tmp_path))


@pytest.mark.skipif(os.geteuid() == 0, reason="root may read everything")
def test_a_file_one_may_not_read_is_refused(tmp_path):
    path = tmp_path / "secret.mid"
    path.write_bytes(midi(on(0, 60) + END))
    path.chmod(0)
    with pytest.raises(ScoreError, match=r"secret\.mid: cannot be read \(permission denied\)"):
        read_score(path)


@pytest.mark.parametrize("name", ["two\nlines.mid", "stray\udcff.mid", "nul\0.mid"])
def test_an_odd_name_still_makes_one_printable_line(name):
    with pytest.raises(ScoreError) as refusal:
        read_score(name)
    assert str(refusal.value).isprintable()


def test_a_huge_file_is_refused_unread(tmp_path):
    path = tmp_path / "huge.mid"
    with path.open("wb") as file:
        file.truncate(64 * 2**20 + 1)
    with pytest.raises(ScoreError, match=r"huge\.mid: larger than 64 MiB"):
        read_score(path)


def test_more_messages_than_memory_should_hold_are_refused(read, monkeypatch):
    monkeypatch.setattr(smf_chunks, "MAX_EVENTS", 3)
    assert len(read(midi(on(0, 60) + off(0, 60) + END, on(0, 62) + END)).events) == 3
    with pytest.raises(ScoreError, match="has more than 3 events"):
        read(midi(on(0, 60) + on(0, 61) + END, tempo(0, 9) + on(0, 63) + END))


def test_more_tracks_than_a_header_can_count_are_refused(read):
    with pytest.raises(ScoreError, match="has more than 65535 tracks"):
        read(midi(on(0, 60), kind=2) + chunk(b"MTrk", b"") * 65_535)


# ---------------------------------------------------------------- cut short


def test_a_file_cut_anywhere_keeps_a_beginning_of_the_whole(read):
    whole = midi(b"".join(on(10, note, channel=9) for note in range(30, 90)) + END)
    full = told(read(whole))
    for length in range(len(whole)):
        try:
            part = told(read(whole[:length]))
        except ScoreError:
            assert length < 22 + 4  # headers and the first note
        else:
            assert part == full[: len(part)]
            assert len(part) == min((length - 22) // 4, 60)


# ---------------------------------------------------------------- one after another


def sound(time_s: float, *data: int) -> ScoreEvent:
    return ScoreEvent(time_s, mido.Message.from_bytes(data))


def test_scores_in_a_row_start_when_the_one_before_has_passed():
    first = Score((sound(0.0, 0x90, 60, 80), sound(1.0, 0x80, 60, 0)), 1.5, "one", ("odd",))
    second = Score((sound(0.25, 0x90, 62, 80), sound(0.5, 0x90, 62, 0)), 1.0, "two")
    both = concatenate([first, second])
    assert told(both) == [
        (0.0, [0x90, 60, 80]),
        (1.0, [0x80, 60, 0]),
        (1.5, [0xFF]),
        (1.75, [0x90, 62, 80]),
        (2.0, [0x90, 62, 0]),
    ]
    assert (both.duration_s, both.name, both.warnings) == (2.5, "one + two", ("one: odd",))


def test_a_long_silence_at_the_end_is_cut_with_a_warning(read):
    score = read(midi(on(0, 60) + off(100, 60) + b"\xff\xff\xff\x7f\xff\x2f\x00"))
    assert score.duration_s == pytest.approx(score.events[-1].time_s + 30.0)
    assert score.warnings == ("silence at the end cut to 30 s, at byte 30",)


def test_nothing_in_a_row_is_nothing():
    assert concatenate([]) == Score((), 0.0)


def test_scores_in_a_row_may_not_last_longer_than_anybody_may_ask_for():
    half = Score((), 3600.0 * 501)
    with pytest.raises(ScoreError, match=r"lasts 1e\+03 hours, more than 1000"):
        concatenate([half, half])


HEAD = b"MThd" + bytes((0, 0, 0, 6, 0, 0, 0, 1, 1, 224))
NOTE = bytes((0, 0x90, 67, 90))


@pytest.mark.parametrize(
    "event",
    [
        bytes((0, 0x90, 0xFF, 0xFF)),
        bytes((0, 0xFF, 0x01, 0)),
        bytes((0, 0xF0, 0)),
        bytes((0, 0xF8)),
        bytes((0, 0xFF, 0x51, 3, 0, 0, 1)),
        NOTE,
    ],
    ids=["damaged", "text", "sysex", "system", "tempo", "note"],
)
def test_events_of_any_kind_are_bounded(tmp_path, monkeypatch, event):
    monkeypatch.setattr(smf_chunks, "MAX_EVENTS", 100)
    path = tmp_path / "x.mid"
    for count, is_read in ((99, True), (100, False)):
        track = NOTE + event * count
        path.write_bytes(HEAD + b"MTrk" + len(track).to_bytes(4, "big") + track)
        if is_read:
            assert read_score(path).events
        else:
            with pytest.raises(ScoreError, match="more than 100 events"):
                read_score(path)


def test_chunks_are_bounded(tmp_path, monkeypatch):
    monkeypatch.setattr(smf_chunks, "MAX_CHUNKS", 10)
    path = tmp_path / "x.mid"
    path.write_bytes(HEAD + b"MTrk\0\0\0\4" + NOTE + b"XXXX\0\0\0\0" * 9)
    assert read_score(path).events
    path.write_bytes(HEAD + b"MTrk\0\0\0\4" + NOTE + b"XXXX\0\0\0\0" * 10)
    with pytest.raises(ScoreError, match="more than 10 chunks"):
        read_score(path)
