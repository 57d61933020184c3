"""The scores in examples/ can be played by a yehu, and show what they are for."""

from collections import defaultdict
from pathlib import Path

import pytest

from yehu_server.scores.events import ScoreEvent
from yehu_server.scores.reading import read_written
from yehu_server.scores.score import Score
from yehu_server.scores.smf.reader import read_score

ROOT = Path(__file__).resolve().parents[2]
SHIPPED = ROOT / "examples"
SECONDS = {
    "shi_bei_jiu": (26, 29), "mo_li_hua": (40, 50), "slow_air": (45, 60),
    "bow_pressure": (28, 35), "mpe_phrase": (20, 25),
}  # fmt: skip
MASTER, MEMBERS = 0, range(1, 16)


@pytest.fixture(scope="module")
def scores() -> dict[str, Score]:
    return {name: read_score(SHIPPED / f"{name}.mid") for name in SECONDS}


def of(score: Score, kind: str, control: int | None = None) -> list[ScoreEvent]:
    return [
        event
        for event in score.events
        if event.message.type == kind and (control is None or event.message.control == control)
    ]


@pytest.mark.parametrize("name", SECONDS)
def test_a_yehu_can_play_it(scores, name):
    """In range, bends and all; every note ends, and at most two of a channel overlap, in slurs."""
    score = scores[name]
    assert score.warnings == ()
    least, most = SECONDS[name]
    assert least <= score.duration_s <= most
    is_mpe = name == "mpe_phrase"
    bends: dict[int, float] = defaultdict(float)
    sounding: list[tuple[int, int]] = []  # channel and note
    for event in score.events:
        message = event.message
        if message.type == "note_on":
            assert message.velocity > 0
            assert (message.channel, message.note) not in sounding
            sounding.append((message.channel, message.note))
            assert sum(is_mpe or channel == message.channel for channel, _ in sounding) <= 2
        elif message.type == "note_off":
            sounding.remove((message.channel, message.note))
        elif message.type == "pitchwheel":
            span = 48.0 if is_mpe and message.channel != MASTER else 2.0
            bends[message.channel] = message.pitch / 8192 * span
        for channel, note in sounding:
            of_all = bends[MASTER] if is_mpe else 0.0
            assert 65.0 <= note + bends[channel] + of_all <= 89.0
    assert not sounding


def test_every_phrase_is_understood_and_lies_within_the_yehu():
    wrong = []
    phrases = sorted((SHIPPED / "phrases").glob("*.jianpu"))
    assert len(phrases) == 12
    for path in phrases:
        written = read_written(path)
        if written.warnings or written.not_understood:
            wrong.append((path.stem, written.warnings, written.not_understood))
        if not all(65.0 <= note.pitch <= 89.0 for part in written.parts for note in part.notes):
            wrong.append((path.stem, "range"))
    assert wrong == []
