"""Captures: written as events happen, readable whatever ends them."""

from __future__ import annotations

import json
import os
import resource
from pathlib import Path

import numpy as np
import pytest
from sound import bow

from yehu_server.engine.controls import SILENCE
from yehu_server.engine.instrument import Instrument
from yehu_server.engine.mailbox import EVENT
from yehu_server.errors import OutputError, ScoreError
from yehu_server.params.table import SLOT
from yehu_server.replay import blocks, replay
from yehu_server.score.capture import CaptureWriter, build, read_capture

RATE = 48000.0
TENSIONS = (49.5, 64.1)
SPEED, SIDE = SLOT["/bow/speed"], SLOT["/bow/side"]


def write(path, events=(), end=None, rests=(), lost=0):
    writer = CaptureWriter(path, rate=RATE, seed=3, tensions=TENSIONS)
    writer.events(np.array(list(events), EVENT))
    for frame in rests:
        writer.note("rest", frame, since=frame)
    if lost:
        writer.note("lost", 5, events=lost)
    if end is not None:
        writer.close(end)
    writer._file.close()  # as a crash does
    return path


EVENTS = [(0, SIDE, 1.0, 480), (7, SPEED, 0.1 + 0.2, 960), (9000, SILENCE, 0.0, 0)]


def test_what_is_written_is_read_to_the_bit(tmp_path):
    capture = read_capture(write(tmp_path / "c", EVENTS, end=12345))
    assert capture.rate == RATE
    assert [tuple(e) for e in capture.events.tolist()] == EVENTS
    assert capture.frames == 12345
    assert capture.warnings == []


def test_the_first_line_tells_the_whole_beginning(tmp_path):
    header = json.loads(write(tmp_path / "c").read_text().splitlines()[0])
    assert header["seed"] == 3
    assert header["build"] == build()
    assert set(header["values"]) == set(SLOT)


def test_a_session_that_crashed_can_be_read(tmp_path):
    path = write(tmp_path / "c", EVENTS)
    path.write_text(path.read_text()[:-9])  # in the middle of the last line
    capture = read_capture(path)
    assert len(capture.events) == 2
    assert capture.frames == 8 + 48000
    assert "did not end properly" in capture.warnings[0]


def test_lost_events_and_another_build_are_told(tmp_path):
    path = write(tmp_path / "c", EVENTS, end=9001, lost=4)
    path.write_text(path.read_text().replace(build()["sources"], "0" * 16))
    warnings = " ".join(read_capture(path).warnings)
    assert "4 events" in warnings
    assert "another build (sources)" in warnings


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("", "not a capture"),
        ("{}", "not a capture"),
        ("[1]", "not a capture"),
        ("\xff\xfe", "not a capture"),
        ('{"format": "yehu-server capture", "version": 99}', "version 99"),
    ],
)
def test_what_is_no_capture_is_refused(tmp_path, text, reason):
    path = tmp_path / "c"
    path.write_bytes(text.encode("latin-1"))
    with pytest.raises(ScoreError, match=reason):
        read_capture(path)


@pytest.mark.parametrize(
    "line",
    [
        "nonsense",
        '[1, "/bow/speed", 0.1]',
        '[1, "/no/such", 0.1, 0]',
        '[-1, "/bow/speed", 0.1, 0]',
        '[1, "/bow/speed", NaN, 0]',
        '[1e300, "/bow/speed", 0.0, 0]',
        "7",
    ],
)
def test_a_damaged_line_is_named(tmp_path, line):
    path = write(tmp_path / "c")
    path.write_text(path.read_text() + line + '\n{"end": 10}\n')
    with pytest.raises(ScoreError, match=str(path)):
        read_capture(path)


def test_events_out_of_order_are_refused(tmp_path):
    with pytest.raises(ScoreError, match="order"):
        read_capture(write(tmp_path / "c", [(5, SPEED, 0.1, 0), (4, SPEED, 0.1, 0)], end=10))


def test_a_missing_file_and_a_missing_folder_are_told(tmp_path):
    with pytest.raises(ScoreError, match="No such file"):
        read_capture(tmp_path / "none")
    with pytest.raises(OutputError, match="does not exist"):
        CaptureWriter(tmp_path / "none" / "c", rate=RATE, seed=0, tensions=TENSIONS)


def test_a_replay_is_what_was_played_in_any_blocks(tmp_path):
    live = Instrument(RATE)
    live.report_events()
    bow(live)
    played = np.zeros(30000, np.float32)
    for start in range(0, 30000, 100):
        if start == 10000:
            live.write("/finger/1/press", 1.5)
        live.process(played[start : start + 100])
    writer = CaptureWriter(tmp_path / "c", rate=RATE, seed=0, tensions=TENSIONS)
    writer.events(live.applied_events())
    writer.close(live.frame)
    again = np.concatenate(list(blocks(read_capture(tmp_path / "c"), Instrument(RATE))))
    assert (again == played).all()
    assert np.abs(played).max() > 0.01


def test_a_rest_in_mid_session_is_replayed(tmp_path):
    live = Instrument(RATE)
    live.report_events()
    bow(live)
    played = np.zeros(20000, np.float32)
    live.process(played[:9000])
    live._rig["meters"]["running"] = 1  # as if the process was killed inside a block
    live.recover()
    live.process(played[9000:])
    assert live.rests == [(9000, 9000)]
    writer = CaptureWriter(tmp_path / "c", rate=RATE, seed=0, tensions=TENSIONS)
    writer.events(live.applied_events())
    writer.note("rest", 9000, since=9000)
    writer.close(live.frame)
    again = np.concatenate(list(blocks(read_capture(tmp_path / "c"), Instrument(RATE))))
    assert (again == played).all()


def test_a_replay_counts_what_it_did(tmp_path):
    capture = read_capture(write(tmp_path / "c", EVENTS, end=9600))
    result = replay(capture, tmp_path / "x.wav", format_name="wav", subtype="float")
    assert result.events == 3
    assert result.duration_s == 0.2
    assert (tmp_path / "x.wav").exists()


def test_a_full_disk_leaves_whole_lines(tmp_path):
    path = tmp_path / "c"
    writer = CaptureWriter(path, rate=RATE, seed=0, tensions=TENSIONS)
    begun = path.read_bytes()
    first = json.dumps([1, "/bow/speed", 0.5, 0]) + "\n"
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (len(begun) + len(first) + 9, hard))
    try:
        with pytest.raises(OutputError, match="cannot write"):
            writer.events(np.array([(1, SPEED, 0.5, 0), (2, SPEED, 0.5, 0)], EVENT))
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert path.read_bytes() == begun + first.encode()
    assert len(read_capture(path).events) == 1


def test_an_older_capture_is_replaced_only_where_that_is_asked_for(tmp_path):
    path = write(tmp_path / "c", EVENTS, end=12345)
    older = path.read_bytes()
    with pytest.raises(OutputError, match="exists"):
        CaptureWriter(path, rate=RATE, seed=0, tensions=TENSIONS)
    assert path.read_bytes() == older
    CaptureWriter(path, rate=RATE, seed=0, tensions=TENSIONS, overwrite=True).close(7)
    assert read_capture(path).frames == 7


def test_a_capture_of_nothing_can_be_taken_back(tmp_path):
    CaptureWriter(tmp_path / "c", rate=RATE, seed=0, tensions=TENSIONS).discard()
    assert list(tmp_path.iterdir()) == []


# ---------------------------------------------------------------- hostile files

HUGE = "9" * 400
DEEP = "[" * 20_000


@pytest.mark.parametrize(
    "line",
    [
        f'[{2**63 - 1}, "/bow/speed", 0.1, 0]',
        f'[{2**80}, "/bow/speed", 0.1, 0]',
        '[1e3, "/bow/speed", 0.1, 0]',
        '[-1, "/bow/speed", 0.1, 0]',
        '[0, "/bow/speed", 9e18, 441]',
        '[0, "/bow/speed", NaN, 0]',
        '[0, "/bow/speed", -Infinity, 0]',
        f'[0, "/bow/speed", {HUGE}, 0]',
        '[0, "/bow/speed", {}, 0]',
        f'[0, "/bow/speed", 0.1, {2**63}]',
        '[0, "/bow/speed", 0.1, -5]',
        '[0, "silence", 1.0, 0]',
        '[0, ["/bow/speed"], 0.1, 0]',
        f'{{"end": {HUGE}}}',
        f'{{"end": {"9" * 5000}}}',
        '{"end": true}',
        '{"rest": 5, "since": 9}',
        '{"rest": 5}',
        '{"lost": 5, "events": -1}',
        '"end"',
        "17",
        DEEP,
        '{"a":' * 10_000,
        "\x00",
    ],
    ids=lambda line: line[:40],
)
def test_a_line_that_no_instrument_wrote_is_named_and_refused(tmp_path, line):
    path = write(tmp_path / "c", EVENTS[:1])
    path.write_text(path.read_text() + line + "\n" + '{"end": 100}\n')
    with pytest.raises(ScoreError, match="line 3: not a line of a capture") as error:
        read_capture(path)
    assert len(str(error.value)) < 300


@pytest.mark.parametrize("rate", [HUGE, "9" * 5000, "0", "-48000", "NaN", "1e999", "null", DEEP])
def test_a_rate_that_is_none_is_refused(tmp_path, rate):
    path = write(tmp_path / "c", EVENTS, end=9001)
    path.write_text(path.read_text().replace(f'"rate": {RATE}', f'"rate": {rate}'))
    with pytest.raises(ScoreError):
        read_capture(path)


@pytest.mark.parametrize("end", [10**12, 2**53])
def test_a_capture_of_years_is_refused_unless_it_is_asked_for(tmp_path, end):
    capture = read_capture(write(tmp_path / "c", EVENTS, end=end))
    with pytest.raises(ScoreError, match="--max-duration"):
        replay(capture, tmp_path / "x.wav", format_name="wav", subtype="16", max_duration_h=12.0)
    assert not (tmp_path / "x.wav").exists()


def test_a_late_rest_is_as_long_as_an_end(tmp_path):
    capture = read_capture(write(tmp_path / "c", EVENTS, end=100, rests=[10**12]))
    assert capture.frames == 10**12


def test_many_rests_are_no_capture(tmp_path):
    with pytest.raises(ScoreError, match="too many"):
        read_capture(write(tmp_path / "c", EVENTS, rests=range(9000, 11000)))


def test_what_is_no_file_of_text_is_refused_at_once(tmp_path):
    os.mkfifo(tmp_path / "fifo")
    (tmp_path / "long").write_bytes(b"[" * 10**6)
    for path in (Path("/dev/zero"), tmp_path / "fifo", tmp_path, tmp_path / "long"):
        with pytest.raises(ScoreError) as error:
            read_capture(path)
        assert str(error.value).startswith(f"{path}: ")


def test_a_long_session_is_read_whole(tmp_path, monkeypatch):
    monkeypatch.setattr("yehu_server.score.capture.CHUNK", 3)
    events = [(frame, SPEED, 0.1, 0) for frame in range(10)]
    assert [tuple(e) for e in read_capture(write(tmp_path / "c", events)).events.tolist()] == events
    monkeypatch.setattr("yehu_server.score.capture.MOST_EVENTS", 8)
    with pytest.raises(ScoreError, match="more than 8 events"):
        read_capture(tmp_path / "c")
