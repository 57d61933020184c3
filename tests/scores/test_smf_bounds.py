"""The reader of MIDI files: what it refuses, files cut short, bounds, and scores in a row."""

import os
from collections.abc import Callable
from pathlib import Path

import mido
import pytest
from midi_bytes import END, chunk, midi, on, tempo
from midi_reading import read_file, timed

from yehu_server.errors import ScoreError
from yehu_server.scores.events import Events, ScoreEvent
from yehu_server.scores.score import Score, concatenate
from yehu_server.scores.smf import chunks as smf_chunks
from yehu_server.scores.smf.reader import read_score


@pytest.fixture
def read(tmp_path: Path) -> Callable[[bytes], Score]:
    return lambda data: read_file(tmp_path, data)


# ---------------------------------------------------------------- refusals


def test_a_path_that_is_no_file_is_refused_in_a_printable_line(tmp_path):
    for path, reason in [
        (tmp_path / "gone.mid", r"gone\.mid: no such file"),
        (str(tmp_path), r"(is a folder|permission denied)"),
        *((name, "") for name in ("two\nlines.mid", "stray\udcff.mid", "nul\0.mid")),
    ]:
        with pytest.raises(ScoreError, match=reason or None) as refusal:
            read_score(path)
        assert str(refusal.value).isprintable()


@pytest.mark.skipif(
    not hasattr(os, "geteuid") or os.geteuid() == 0,
    reason="root may read everything, and Windows has no modes",
)
def test_a_file_one_may_not_read_is_refused(tmp_path):
    path = tmp_path / "secret.mid"
    path.write_bytes(midi(on(0, 60) + END))
    path.chmod(0)
    with pytest.raises(ScoreError, match=r"secret\.mid: permission denied"):
        read_score(path)


def test_more_tracks_than_a_header_can_count_are_refused(read):
    with pytest.raises(ScoreError, match="has more than 65535 tracks"):
        read(midi(on(0, 60), kind=2) + chunk(b"MTrk", b"") * 65_535)


# ---------------------------------------------------------------- cut short


def test_a_file_cut_anywhere_keeps_a_beginning_of_the_whole(read):
    whole = midi(b"".join(on(10, note, channel=9) for note in range(30, 90)) + END)
    full = timed(read(whole))
    for length in range(len(whole)):
        try:
            part = timed(read(whole[:length]))
        except ScoreError:
            assert length < 22 + 4  # headers and the first note
        else:
            assert part == full[: len(part)]
            assert len(part) == min((length - 22) // 4, 60)


# ---------------------------------------------------------------- one after another


def sound(time_s: float, *data: int) -> ScoreEvent:
    return ScoreEvent(time_s, mido.Message.from_bytes(data))


BEGUN = sound(0.0, 0x90, 60, 80), sound(1.0, 0x80, 60, 0)
LATER = sound(0.25, 0x90, 62, 80), sound(0.5, 0x90, 62, 0)


def test_scores_in_a_row_start_when_the_one_before_has_passed():
    first = Score(Events.of(BEGUN), 1.5, "one", ("odd",))
    second = Score(Events.of(LATER), 1.0, "two")
    both = concatenate([first, second])
    assert timed(both) == [
        (0.0, [0x90, 60, 80]),
        (1.0, [0x80, 60, 0]),
        (1.5, [0xFF]),
        (1.75, [0x90, 62, 80]),
        (2.0, [0x90, 62, 0]),
    ]
    assert (both.duration_s, both.name, both.warnings) == (2.5, "one + two", ("one: odd",))


def test_scores_in_a_row_may_not_last_longer_than_anybody_may_ask_for():
    half = Score(Events.of(()), 3600.0 * 501)
    with pytest.raises(ScoreError, match=r"lasts 1e\+03 hours, more than 1000"):
        concatenate([half, half])


NOTE = on(0, 67)


def test_events_of_any_kind_are_bounded(subtests, read, monkeypatch):
    monkeypatch.setattr(smf_chunks, "MAX_EVENTS", 100)
    for kind, event in {
        "damaged": bytes((0, 0x90, 0xFF, 0xFF)),
        "text": bytes((0, 0xFF, 0x01, 0)),
        "sysex": bytes((0, 0xF0, 0)),
        "system": bytes((0, 0xF8)),
        "tempo": tempo(0, 1),
        "note": NOTE,
    }.items():
        with subtests.test(kind=kind):
            assert read(midi(NOTE + event * 49, event * 50)).events
            with pytest.raises(ScoreError, match="more than 100 events"):
                read(midi(NOTE + event * 50, event * 50))


def test_chunks_are_bounded(read, monkeypatch):
    monkeypatch.setattr(smf_chunks, "MAX_CHUNKS", 10)
    assert read(midi(NOTE) + chunk(b"XXXX", b"") * 9).events
    with pytest.raises(ScoreError, match="more than 10 chunks"):
        read(midi(NOTE) + chunk(b"XXXX", b"") * 10)
