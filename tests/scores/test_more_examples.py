"""The scores of scripts/make_examples.py keep what their descriptions promise."""

from __future__ import annotations

import subprocess
import sys
from collections import defaultdict
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

import mido
import pytest

from yehu_server.scores.score import Score, ScoreEvent
from yehu_server.scores.smf.reader import read_score

ROOT = Path(__file__).resolve().parents[2]
SHIPPED = ROOT / "examples"
SECONDS = {"slow_air": (45, 60), "bow_pressure": (28, 35), "mpe_phrase": (20, 25)}
NAMES = list(SECONDS)
KEYBOARD = ["slow_air", "bow_pressure"]
MPE = "mpe_phrase"
MASTER, MEMBERS = 0, range(1, 16)


@pytest.fixture(scope="module")
def scores() -> dict[str, Score]:
    return {name: read_score(SHIPPED / f"{name}.mid") for name in NAMES}


def of(score: Score, kind: str, control: int | None = None) -> list[ScoreEvent]:
    return [
        event
        for event in score.events
        if event.message.type == kind and (control is None or event.message.control == control)
    ]


def with_sounding(score: Score) -> Iterator[tuple[ScoreEvent, list[tuple[int, int]]]]:
    """Each event, with the notes (channel, note) that sound before it, the latest last."""
    sounding: list[tuple[int, int]] = []
    for event in score.events:
        yield event, list(sounding)
        match event.message:
            case mido.Message(type="note_on") as on:
                sounding.append((on.channel, on.note))
            case mido.Message(type="note_off") as off:
                sounding.remove((off.channel, off.note))


def steps(score: Score, kind: str, control: int | None = None) -> list[int]:
    """The steps of a controller while a note of its channel sounds.

    A move at the very begin of a note belongs to that note, not to the one before.
    """
    begins = {(event.message.channel, event.time_s) for event in of(score, "note_on")}
    at: dict[int, int] = {}
    found = []
    for event, sounding in with_sounding(score):
        message = event.message
        if message.type != kind or control not in (None, getattr(message, "control", None)):
            continue
        value = message.value if kind != "pitchwheel" else message.pitch
        began = (message.channel, event.time_s) in begins
        if not began and any(channel == message.channel for channel, _ in sounding):
            found.append(abs(value - at[message.channel]))
        at[message.channel] = value
    return found


def test_making_the_examples_again_gives_the_shipped_bytes(tmp_path):
    script = ROOT / "scripts" / "make_examples.py"
    subprocess.run([sys.executable, script, *NAMES, "-o", tmp_path], check=True)
    for name in NAMES:
        shipped = (SHIPPED / f"{name}.mid").read_bytes()
        assert (tmp_path / f"{name}.mid").read_bytes() == shipped
    assert len(list(tmp_path.iterdir())) == len(NAMES)


def test_one_example_can_be_made_by_its_name(tmp_path):
    script = ROOT / "scripts" / "make_examples.py"
    subprocess.run([sys.executable, script, MPE, "-o", tmp_path], check=True)
    assert [path.name for path in tmp_path.iterdir()] == ["mpe_phrase.mid"]


@pytest.mark.parametrize("name", NAMES)
def test_an_example_is_a_whole_file_and_lasts_as_long_as_it_says(scores, name):
    file = mido.MidiFile(SHIPPED / f"{name}.mid")
    assert (file.type, file.ticks_per_beat) == (1, 480)
    assert all(track[0].type == "track_name" for track in file.tracks)
    assert all(track[-1].type == "end_of_track" for track in file.tracks)
    assert any(message.type == "set_tempo" for message in file.tracks[0])
    assert scores[name].warnings == ()
    least, most = SECONDS[name]
    assert least <= scores[name].duration_s <= most
    assert 1.0 < scores[name].duration_s - of(scores[name], "note_off")[-1].time_s < 3.0


@pytest.mark.parametrize("name", NAMES)
def test_every_note_ends_and_at_most_two_overlap(scores, name):
    sounding: list[tuple[int, int]] = []
    for event, sounding in with_sounding(scores[name]):
        if event.message.type == "note_on":
            assert event.message.velocity > 0
            assert (event.message.channel, event.message.note) not in sounding
            assert len(sounding) <= 1  # a slur
    assert len(sounding) == 1
    assert scores[name].events[-1].message.type == "note_off"


@pytest.mark.parametrize("name", NAMES)
def test_pitches_stay_within_the_yehu_bends_and_all(scores, name):
    ranges: dict[int, float] = defaultdict(lambda: 2.0)
    bends: dict[int, float] = defaultdict(float)
    rpn: dict[tuple[int, int], int] = {}
    for event, sounding in with_sounding(scores[name]):
        message = event.message
        if message.type == "control_change":
            rpn[message.channel, message.control] = message.value
            selected = (rpn.get((message.channel, 101)), rpn.get((message.channel, 100)))
            if message.control == 6 and selected == (0, 0):
                ranges[message.channel] = message.value
        elif message.type == "pitchwheel":
            bends[message.channel] = message.pitch / 8192 * ranges[message.channel]
        started = [(message.channel, message.note)] if message.type == "note_on" else []
        for channel, note in sounding + started:
            master = bends[MASTER] if name == MPE else 0.0
            assert 65.0 <= note + bends[channel] + master <= 89.0
    if name == MPE:
        assert ranges == {MASTER: 2, **dict.fromkeys(MEMBERS, 48)}


@pytest.mark.parametrize("name", NAMES)
def test_every_controller_has_its_value_before_the_first_note(scores, name):
    first = of(scores[name], "note_on")[0].time_s
    assert first > 0.5

    def moved(events: list[ScoreEvent]) -> set[tuple]:
        return {
            (event.message.type, event.message.channel, getattr(event.message, "control", None))
            for event in events
            if event.message.type not in ("note_on", "note_off")
        }

    before = [event for event in scores[name].events if event.time_s < first]
    assert moved(before) == moved(list(scores[name].events))


@pytest.mark.parametrize("name", KEYBOARD)
def test_the_controllers_of_the_keyboard_scores_move_smoothly(scores, name):
    assert {event.message.channel for event in scores[name].events} == {0}
    for control, most in ((11, 3), (1, 8), (71, 5), (74, 5)):
        assert max(steps(scores[name], "control_change", control), default=0) <= most
    assert not of(scores[name], "pitchwheel")


def test_the_slow_air_swells_and_its_vibrato_comes_late_and_goes(scores):
    air = scores["slow_air"]
    loudness = [event.message.value for event in of(air, "control_change", 11)]
    assert min(loudness) < 15
    assert 100 < max(loudness) < 127
    depths = of(air, "control_change", 1)
    assert 60 < max(event.message.value for event in depths) < 100
    deep = [event.time_s for event in depths if event.message.value > 0]
    for on in of(air, "note_on"):
        assert not any(on.time_s <= time_s < on.time_s + 0.5 for time_s in deep)
    velocities = {event.message.velocity for event in of(air, "note_on")}
    assert min(velocities) < 40
    assert max(velocities) > 100


def test_each_slide_of_the_slow_air_is_two_overlapping_notes(scores):
    air = scores["slow_air"]
    switch = of(air, "control_change", 65)[1:]  # the first one puts it off at the start
    assert [event.message.value for event in switch] == [127, 0] * 3
    events = list(with_sounding(air))
    for on, off in zip(switch[::2], switch[1::2], strict=True):
        starts = [
            sounding
            for event, sounding in events
            if event.message.type == "note_on" and on.time_s <= event.time_s < off.time_s
        ]
        assert [len(sounding) for sounding in starts] == [1]


def test_the_study_sweeps_one_controller_at_a_time_on_both_strings(scores):
    study = scores["bow_pressure"]
    assert {event.message.value for event in of(study, "control_change", 11)} == {84}
    ons, offs = of(study, "note_on"), of(study, "note_off")
    assert [event.message.note for event in ons[:8]] == [67, 70, 74, 79] * 2
    for number, (on, off) in enumerate(zip(ons[:8], offs[:8], strict=True)):
        for control in (71, 74):
            path = [
                event.message.value
                for event in of(study, "control_change", control)
                if on.time_s <= event.time_s <= off.time_s
            ]
            if control == (71, 74)[number // 4]:
                top = path.index(max(path))
                assert (path[0], path[top], path[-1]) == (0, 127, 0)
                assert path == sorted(path[:top]) + sorted(path[top:], reverse=True)
            else:
                assert path == [{71: 40, 74: 64}[control]]


def test_the_phrase_of_the_study_comes_three_times_each_with_more_force(scores):
    study = scores["bow_pressure"]
    notes = [event.message.note for event in of(study, "note_on")[8:]]
    once = notes[: len(notes) // 3]
    assert notes == once * 3
    begin = of(study, "note_on")[8].time_s
    forces = [event for event in of(study, "control_change", 71) if event.time_s >= begin]
    assert [event.message.value for event in forces] == [8, 40, 100]


def test_the_mpe_phrase_begins_with_its_zone(scores):
    opening = [event.message for event in scores[MPE].events[:3]]
    assert [(word.channel, word.control, word.value) for word in opening] == [
        (MASTER, 101, 0),
        (MASTER, 100, 6),
        (MASTER, 6, 15),
    ]


def test_the_notes_of_the_mpe_phrase_take_the_member_channels_in_turn(scores):
    channels = [event.message.channel for event in of(scores[MPE], "note_on")]
    assert channels == [1 + number % 15 for number in range(len(channels))]
    overlapping = [
        sounding
        for event, sounding in with_sounding(scores[MPE])
        if event.message.type == "note_on" and sounding
    ]
    assert len(overlapping) > 10


def test_what_a_note_of_the_mpe_phrase_has_of_its_own_precedes_it_and_moves_smoothly(scores):
    phrase = scores[MPE]
    for on in of(phrase, "note_on"):
        at = phrase.events.index(on)
        kinds = {
            event.message.type
            for event in phrase.events[:at]
            if event.time_s == on.time_s and event.message.channel == on.message.channel
        }
        assert kinds == {"pitchwheel", "aftertouch", "control_change"}
    assert max(steps(phrase, "aftertouch")) <= 3
    assert max(steps(phrase, "control_change", 74)) <= 2
    assert max(steps(phrase, "pitchwheel")) / 8192 * 4800 <= 20  # cents
    pressures = [event.message.value for event in of(phrase, "aftertouch")]
    assert max(pressures) > 100


def test_the_mpe_phrase_glides_a_fourth_and_shakes_by_25_cents(scores):
    cents = [
        event.message.pitch / 8192 * 4800
        for event in of(scores[MPE], "pitchwheel")
        if event.message.channel != MASTER
    ]
    assert 500 < max(cents) < 530
    assert min(cents) == pytest.approx(-180, abs=1)
    last = of(scores[MPE], "note_on")[-1]
    shaken = [
        event.message.pitch / 8192 * 4800
        for event in of(scores[MPE], "pitchwheel")
        if event.message.channel == last.message.channel and event.time_s > last.time_s + 0.3
    ]
    assert 20 < max(shaken) <= 25.5
    assert -25.5 <= min(shaken) < -20
    turns = sum(before <= 0 < after for before, after in pairwise(shaken))
    assert turns > 10


def test_the_master_channel_bends_the_last_note_of_the_mpe_phrase_only(scores):
    master = [event for event in of(scores[MPE], "pitchwheel") if event.message.channel == MASTER]
    last = of(scores[MPE], "note_on")[-1].time_s
    assert master[0].time_s == 0.0
    assert all(event.time_s >= last for event in master[1:])
    assert min(event.message.pitch for event in master) == -8192
    assert max(event.message.pitch for event in master) == 0
    assert master[-1].message.pitch == 0
    falls = [after.message.pitch - before.message.pitch for before, after in pairwise(master)]
    assert max(map(abs, falls)) / 8192 * 200 <= 8  # cents at a time
