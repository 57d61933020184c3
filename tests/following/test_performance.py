"""The performance that a recording becomes; no tracker is needed for it."""

import numpy as np
import pytest

from yehu_server.following.frames import HOP_S
from yehu_server.following.heard import Heard
from yehu_server.following.notes import strokes_of
from yehu_server.following.performance import FollowOptions, dynamics_of, performed
from yehu_server.scores.events import Setting
from yehu_server.scores.midi_export import midi_of_performance
from yehu_server.scores.smf.reader import read_score


def heard(pitches, level=-20.0):
    """What would be heard of a pitch for each frame (fractional MIDI note); NaN is silence."""
    pitches = np.asarray(pitches, float)
    hz = 440.0 * 2.0 ** ((pitches - 69.0) / 12.0)
    levels = np.where(np.isfinite(pitches), level, -90.0)
    return Heard("hum", hz, levels, np.zeros(len(pitches)), np.isfinite(pitches) * 1.0)


def held(*notes):
    """Frames of notes: rows of pitch and number of frames."""
    return np.concatenate([np.full(frames, pitch) for pitch, frames in notes])


def played(pitches, **wanted):
    found = heard(pitches, **({"level": wanted.pop("level")} if "level" in wanted else {}))
    return performed(found, strokes_of(found), FollowOptions(**wanted))


def settings(found, address):
    """The values that a parameter is set to, in order."""
    messages = (event.message for event in found.score.events)
    return [each.value for each in messages if getattr(each, "address", None) == address]


def asked(found, frame):
    """The pitch that is asked for at a frame."""
    key = bend = np.nan
    for event in found.score.events:
        if event.time_s > frame * HOP_S + 1e-9:
            break
        if isinstance(event.message, Setting) and event.message.address == "/playing/bend":
            bend = event.message.value
        elif event.message.type == "note_on":
            key = event.message.note
    return key + bend


def test_low_voices_are_moved_by_octaves_as_little_as_can_be():
    for pitch, semitones in ((45.0, 24.0), (57.0, 12.0), (69.0, 0.0), (100.0, -12.0)):
        found = played(held((np.nan, 20), (pitch, 100), (np.nan, 20)))
        assert found.semitones == semitones
        assert asked(found, 60) == pytest.approx(pitch + semitones, abs=0.02)


def test_a_correction_moves_notes_to_the_tuning():
    swing, rest = 70.3 + 0.4 * np.sin(np.arange(200) * 0.2), held((np.nan, 9))
    curves = []
    for wanted in ({}, {"correct": 1.0, "keeps_vibrato": True}, {"correct": 1.0}):
        found = played(np.concatenate((rest, swing, rest)), **wanted)
        curves.append(np.array([asked(found, frame) for frame in range(60, 180)]))
    assert np.median(curves[0]) == pytest.approx(70.3, abs=0.05)
    assert np.median(curves[1]) == pytest.approx(70.0, abs=0.05)
    assert np.ptp(curves[1]) == pytest.approx(np.ptp(curves[0]), abs=0.05)
    assert np.allclose(curves[2], 70.0, atol=0.05)


def test_slurred_notes_overlap_and_new_strokes_do_not():
    found = played(held((np.nan, 9), (70.0, 80), (72.0, 80), (np.nan, 20), (72.0, 80), (np.nan, 9)))
    first, second, third = found.score.notes
    assert (first.key, second.key, third.key) == (70, 72, 72)
    order = [event.message.type for event in found.score.events if event.message.type[:4] == "note"]
    assert order == ["note_on", "note_on", "note_off", "note_off", "note_on", "note_off"]
    assert third.start_s - second.end_s == pytest.approx(20 * HOP_S, abs=1e-9)
    assert found.strokes == 2


def test_dynamics_are_as_loud_as_their_source_says():
    # docs/playing.md: dynamics 0.5 is some 12 dB below 1, and 0.1 some 35 dB.
    assert dynamics_of(np.array([0.0, -12.0, -35.0])) == pytest.approx([1.0, 0.5, 0.1], abs=0.06)


def test_its_midi_file_has_the_same_notes_and_bends(tmp_path):
    found = played(held((np.nan, 9), (70.3, 100), (73.4, 100), (np.nan, 9)))
    data, lost = midi_of_performance(found.score, 0.5)
    (tmp_path / "hum.mid").write_bytes(data)
    again = read_score(tmp_path / "hum.mid")
    assert [note.key for note in again.notes] == [note.key for note in found.score.notes]
    wheel = [event.message.pitch for event in again.events if event.message.type == "pitchwheel"]
    assert wheel[0] * 24 / 8191 == pytest.approx(0.3, abs=0.01)
    assert set(lost) == {"/playing/attack", "/playing/phrasing", "/playing/variation"}


def test_a_c5_that_moves_is_not_played_on_the_open_string():
    swing, rest = 72.0 + 0.3 * np.sin(np.arange(120) * 0.2), (np.nan, 20)
    begins, ends = held((np.nan, 9), (72.0, 80), rest), held(rest, (79.0, 80), (np.nan, 9))
    found = played(np.concatenate((begins, swing, ends)))
    assert settings(found, "/playing/string") == [1.0, None]
