"""Parts of a score: what a channel, or a track, has to play."""

from __future__ import annotations

import mido

from yehu_server.scores.reading import channels_with_notes, part_of, tracks_with_notes
from yehu_server.scores.score import COMMON_TIME, Metre, Score, ScoreEvent, concatenate
from yehu_server.scores.smf.reader import read_score


def on(channel: int, track: int, note: int = 70) -> ScoreEvent:
    return ScoreEvent(0.0, mido.Message("note_on", channel=channel, note=note), 0.0, track)


def control(channel: int, track: int) -> ScoreEvent:
    return ScoreEvent(0.0, mido.Message("control_change", channel=channel, control=1), 0.0, track)


RESET = ScoreEvent(0.5, mido.Message("reset"))
SCORE = Score((control(0, 1), control(3, 1), on(0, 2), on(1, 2), on(0, 3), on(9, 4), RESET), 1.0)


def test_channels_and_tracks_with_notes_are_found():
    assert channels_with_notes([SCORE]) == [0, 1, 9]
    assert tracks_with_notes([SCORE]) == [2, 3]


def test_a_channel_has_its_events_and_what_moves_all():
    assert part_of(SCORE, channel=0).events == (control(0, 1), on(0, 2), on(0, 3), RESET)


def test_a_track_has_its_events_and_controllers_of_its_channels_from_tracks_without_notes():
    assert part_of(SCORE, track=2).events == (control(0, 1), on(0, 2), on(1, 2), RESET)
    assert part_of(SCORE, track=4).events == (on(9, 4), RESET)


def test_a_part_may_be_one_channel_of_one_track():
    assert part_of(SCORE, channel=1, track=2).events == (on(1, 2), RESET)


def test_a_part_is_as_long_as_its_score():
    assert part_of(SCORE, channel=7).duration_s == SCORE.duration_s


def test_events_of_a_file_know_their_track(tmp_path):
    file = mido.MidiFile(type=1)
    for channel in (None, 2, 4):
        track = file.add_track()
        if channel is not None:
            track.append(mido.Message("note_on", channel=channel, note=70, time=10))
    file.save(tmp_path / "three.mid")
    score = read_score(tmp_path / "three.mid")
    assert [(event.message.channel, event.track) for event in score.events] == [(2, 2), (4, 3)]
    joined = concatenate([score, score])
    assert [event.track for event in joined.events] == [2, 3, 0, 2, 3]


def test_joined_scores_of_one_metre_keep_it():
    """Their beats begin anew with each, so their bars do."""
    waltz, march = (Score((), 1.0, metres=(COMMON_TIME, Metre(0.0, n))) for n in (3.0, 2.0))
    assert concatenate([waltz, waltz]).bar_at(4.0) == (0.0, 3.0)
    assert concatenate([waltz, march]).bar_at(4.0) == (0.0, 4.0)


def test_the_songs_of_format_2_are_tracks(tmp_path):
    file = mido.MidiFile(type=2)
    for note in (70, 72):
        file.add_track().append(mido.Message("note_on", note=note, time=10))
    file.save(tmp_path / "songs.mid")
    events = read_score(tmp_path / "songs.mid").events
    assert [event.track for event in events if event.message.type == "note_on"] == [1, 2]
