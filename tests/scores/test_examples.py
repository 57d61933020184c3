"""The scores in examples/: made again byte for byte, for a yehu, and as their makers say.

What `scripts/tunes/examples.py` says of each score is tested.
"""

from __future__ import annotations

from collections import defaultdict
from itertools import pairwise
from pathlib import Path

import pytest

from yehu_server.scores.reading import channels_with_notes, part_of, read_written
from yehu_server.scores.score import Score, ScoreEvent, ScoreNote, notes_of
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


def values(score: Score, control: int) -> list[int]:
    return [event.message.value for event in of(score, "control_change", control)]


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


def test_shi_bei_jiu_ends_on_a_long_note_with_everything_at_rest(scores):
    tune = scores["shi_bei_jiu"]
    assert tune.duration_s - of(tune, "note_on")[-1].time_s > 1.5
    assert of(tune, "pitchwheel")[-1].message.pitch == 0
    assert of(tune, "aftertouch")[-1].message.value == 0


def test_the_slow_air_swells_and_its_vibrato_comes_late_and_its_slides_are_slurs(scores):
    air = scores["slow_air"]
    loudness = values(air, 11)
    assert min(loudness) < 15
    assert 100 < max(loudness) < 127
    deep = [event.time_s for event in of(air, "control_change", 1) if event.message.value > 0]
    notes = notes_of(air)
    assert deep
    assert not any(n.start_s <= time_s < n.start_s + 0.5 for time_s in deep for n in notes)
    switch = of(air, "control_change", 65)[1:]  # the first one puts it off at the start
    assert [event.message.value for event in switch] == [127, 0] * 3
    for on, off in zip(switch[::2], switch[1::2], strict=True):
        slid = [at for at, n in enumerate(notes) if on.time_s <= n.start_s < off.time_s]
        assert [notes[at - 1].end_s > notes[at].start_s for at in slid] == [True]


def test_the_study_sweeps_one_controller_at_a_time_on_both_strings_then_plays_with_more_force(
    scores,
):
    study = scores["bow_pressure"]
    notes = notes_of(study)
    assert [note.key for note in notes[:8]] == [67, 70, 74, 79] * 2
    for number, note in enumerate(notes[:8]):
        for control, rest in ((71, 40), (74, 64)):
            path = [
                event.message.value
                for event in of(study, "control_change", control)
                if note.start_s <= event.time_s <= note.end_s
            ]
            if control == (71, 74)[number // 4]:
                top = path.index(max(path))
                assert (path[0], path[top], path[-1]) == (0, 127, 0)
                assert path == sorted(path[:top]) + sorted(path[top:], reverse=True)
            else:
                assert path == [rest]
    phrase = [note.key for note in notes[8:]]
    assert phrase == phrase[: len(phrase) // 3] * 3
    assert values(study, 71)[-3:] == [8, 40, 100]


def test_the_mpe_phrase_begins_with_its_zone_and_gives_each_note_its_own_bend_touch_and_bow(scores):
    score = scores["mpe_phrase"]
    opening = [event.message for event in score.events[:3]]
    assert [(word.channel, word.control, word.value) for word in opening] == [
        (MASTER, 101, 0),
        (MASTER, 100, 6),
        (MASTER, 6, 15),
    ]
    notes = of(score, "note_on")
    channels = [event.message.channel for event in notes]
    assert channels == [MEMBERS[number % 15] for number in range(len(channels))]
    for on in notes:
        before = {
            event.message.type
            for event in score.events[: score.events.index(on)]
            if (event.time_s, event.message.channel) == (on.time_s, on.message.channel)
        }
        assert before == {"pitchwheel", "aftertouch", "control_change"}
    master = [event for event in of(score, "pitchwheel") if event.message.channel == MASTER]
    assert all(event.time_s >= notes[-1].time_s for event in master[1:])
    assert min(event.message.pitch for event in master) == -8192
    assert master[-1].message.pitch == 0


def on_beats(notes: list[ScoreNote]) -> dict[float, int]:
    return {note.beat: note.key for note in notes if note.beat == round(note.beat)}


def test_mo_li_hua_has_one_tune_four_times_plain_in_more_and_in_fewer_notes_and_higher(scores):
    assert channels_with_notes([scores["mo_li_hua"]]) == [0, 1, 2, 3]
    parts = [notes_of(part_of(scores["mo_li_hua"], channel)) for channel in range(4)]
    plain, flowers, bones, octave = parts
    tune = on_beats(plain)
    for notes in parts:
        assert {note.key % 12 for note in notes} <= {10, 0, 2, 5, 7}  # of B flat, no fa and ti
        assert all(note.end_s < after.start_s + 0.02 for note, after in pairwise(notes))
        own = on_beats(notes)
        both = tune.keys() & own.keys()
        assert len(both) > 0.7 * len(own)
        assert all((own[beat] - tune[beat]) % 12 == 0 for beat in both)
    assert len(flowers) > 2 * len(plain)
    assert len(bones) < 0.5 * len(plain)
    higher = {a.start_s: b.key - a.key for a, b in zip(plain, octave, strict=True)}
    assert list(higher) == [note.start_s for note in octave]
    assert set(higher.values()) == {0, 12}


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
