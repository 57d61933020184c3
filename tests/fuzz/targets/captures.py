"""Captured sessions."""

import numpy as np
from fuzz.instrument import Instrument
from fuzz.target import scratch, target, words, written

from yehu_server.core.controls.slots import LOWER_BOUNDS, SILENCE, UPPER_BOUNDS
from yehu_server.core.engine.rig import MAX_PARTS
from yehu_server.core.physics.grid import check_rate
from yehu_server.core.player.commands import KINDS, RAMP
from yehu_server.errors import YehuError
from yehu_server.params.table import find
from yehu_server.scores.capture import Capture, read_capture
from yehu_server.scores.capture_format import MAX_FRAMES
from yehu_server.scores.capture_header import SessionStart
from yehu_server.scores.capture_writer import CaptureWriter

WORDS = (
    *words(
        b'{"end": |{"rest": |, "since": |{"lost": 1, "events": 1}|\n[0, |, 0]\n|"version": 1',
        b'"version": 2|"version": 3|"players": |"quantities": |\n[0, 1, |"/bow/speed"',
        b'"/playing/bend"|"/finger/1/position"|"silence"|1e308|NaN|Infinity',
    ),
    *(f'"{kind}", '.encode() for kind in KINDS),
)
MAX_APPLIED = 2000


def check_beginning(beginning: SessionStart) -> None:
    """A replay begins with this check; what else it starts from is in range."""
    check_rate(beginning.rate)
    assert 1 <= len(beginning.players) <= MAX_PARTS
    for start in beginning.players:
        assert all(find(one).lo <= value <= find(one).hi for one, value in start.values.items())
        assert np.isfinite(start.bowing).all()
        if start.calibration is not None:
            measured = start.calibration
            for tables in (
                measured.sharpening,
                measured.levels,
                measured.centroids,
                measured.louder,
            ):
                assert all(np.isfinite(table).all() for table in tables)


def check_commands(taken: Capture) -> None:
    """Whatever is requested, it is written as it was read, and no parameter leaves its range."""
    commands = taken.commands
    assert (commands["frame"] >= 0).all()
    assert (commands["frame"] <= taken.frames).all()
    assert np.isfinite(commands["value"]).all()
    ramps = commands[(commands["kind"] == RAMP) & (commands["index"] != SILENCE)]
    assert (ramps["value"] >= LOWER_BOUNDS[ramps["index"]]).all()
    assert (ramps["value"] <= UPPER_BOUNDS[ramps["index"]]).all()
    assert ((ramps["other"] >= 0) & (ramps["other"] <= MAX_FRAMES)).all()
    instrument = Instrument()
    for frame, *command in commands[:MAX_APPLIED].tolist():
        instrument.now_s = frame / instrument.rate
        instrument.apply(tuple(command))
    instrument.check_player()


@target("capture", YehuError, words=WORDS)
def capture(data: bytes) -> None:
    """A capture has a length, its commands are in range, and it can be written again."""
    path = written(data, "file.jsonl")
    taken = read_capture(path)
    check_beginning(taken.beginning)
    assert 0 <= taken.frames <= MAX_FRAMES  # replay sets a bound of its own: --max-duration
    assert all(0 <= since <= rest <= MAX_FRAMES for rest, since in taken.gaps.items())
    check_commands(taken)
    again = scratch() / "again.jsonl"
    again.unlink(missing_ok=True)
    writer = CaptureWriter(again, beginning=taken.beginning)
    for player in range(len(taken.beginning.players)):
        writer.commands(taken.commands[taken.players == player], player)
    for rest, since in taken.gaps.items():
        writer.note("rest", rest, since=since)
    writer.close(taken.frames)
    read = read_capture(again)
    for player, start in enumerate(taken.beginning.players):
        ours, theirs = read.players == player, taken.players == player
        assert np.array_equal(read.commands[ours], taken.commands[theirs])
        written_start = read.beginning.players[player]
        assert np.array_equal(written_start.bowing, start.bowing)
        for what in ("quantities", "seed", "open_strings", "calibration", "values", "body"):
            assert getattr(written_start, what) == getattr(start, what), what
    assert read.beginning.rate == taken.beginning.rate
    assert read.beginning.has_room == taken.beginning.has_room
    assert read.gaps == taken.gaps
    assert read.end == taken.frames
