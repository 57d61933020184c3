"""Files of bytes as the reader of MIDI files reads them, for tests."""

from pathlib import Path

from yehu_server.scores.score import Score
from yehu_server.scores.smf.reader import read_score


def read_file(folder: Path, data: bytes) -> Score:
    """The score of a file of these bytes, which is written into the folder."""
    path = folder / "tune.mid"
    path.write_bytes(data)
    return read_score(path)


def timed(score: Score) -> list[tuple[float, list[int]]]:
    """Its messages with their times."""
    return [(event.time_s, event.message.bytes()) for event in score.events]
