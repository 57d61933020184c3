"""MIDI files."""

import math
import re
from pathlib import Path

import mido
from fuzz.target import target, written

from yehu_server.errors import ScoreError
from yehu_server.scores.score import MAX_DURATION_H, Score
from yehu_server.scores.smf.reader import read_score
from yehu_server.scores.smf.track import DamagedError

MAX_SONGS = 3
NO_SONG = re.compile("there is no song|has nothing to play")


@target(
    "midi-file",
    ScoreError,
    words=(b"MThd\0\0\0\6", b"MTrk", b"RIFF", b"RMIDdata", b"\xff\x51\3", b"\xff\x2f\0", b"\xf0\4"),
)
def midi_file(data: bytes) -> None:
    """A file is a score of valid messages in order within two hours, or a ScoreError.

    It is read strictly too, and each of its songs.
    """
    path = written(data, "file.mid")
    score = read_score(path)
    assert score.events
    check_score(score)
    for warning in score.warnings:
        at = re.fullmatch(r".*at byte (\d+)", warning)
        assert at, warning
        assert int(at[1]) <= len(data), warning
    try:
        assert len(read_score(path, strict=True).events) == len(score.events)
    except DamagedError:
        assert score.warnings
    else:
        assert not score.warnings
    songs = [read_song(path, number) for number in range(1, MAX_SONGS + 1)]
    resets = sum(event.message.type == "reset" for event in score.events)
    assert sum(song is not None for song in songs) <= resets + 1


def check_score(score: Score) -> None:
    """Every message is valid, and at its time."""
    times = [event.time_s for event in score.events]
    assert times == sorted(times)
    assert 0.0 <= times[0] <= times[-1] <= score.duration_s <= MAX_DURATION_H * 3600
    assert math.isfinite(score.duration_s)
    for event in score.events:
        message = event.message
        assert message.type == "reset" or hasattr(message, "channel")
        assert mido.Message.from_bytes(message.bytes()) == message


def read_song(path: Path, number: int) -> Score | None:
    """One song of a file that is read as a whole; None where it has no such song."""
    try:
        song = read_score(path, song=number)
    except ScoreError as refusal:
        if not NO_SONG.search(str(refusal)):
            raise AssertionError(number) from refusal
        return None
    check_score(song)
    assert not any(event.message.type == "reset" for event in song.events)
    return song
