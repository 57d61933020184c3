"""Tuning by system exclusive: notes move by semitones, and the rest is a bend."""

import mido
import pytest

from yehu_server.scores.events import Setting
from yehu_server.scores.smf.reader import read_score

ALL = (3, 127, 127)  # channels, of scale tunings
FINE = (0x7F, 0x7F, 4, 3)
COARSE = (0x7F, 0x7F, 4, 4)


def scale(cents: list[int], channels=ALL) -> tuple[int, ...]:
    return (0x7E, 0x7F, 8, 8, *channels, *(64 + each for each in cents))


def scale_14(semitones: list[float]) -> tuple[int, ...]:
    values = [min(round(8192 * (1 + each)), 16383) for each in semitones]
    return (0x7E, 0x7F, 8, 9, *ALL, *(part for each in values for part in (each >> 7, each & 127)))


@pytest.fixture
def pitches(tmp_path):
    """What keys sound like (semitones), of each (message before it or None, key, channel)."""

    def run(*steps, wheel=None):
        track = mido.MidiTrack()
        if wheel is not None:
            track.append(mido.Message("pitchwheel", pitch=0, channel=wheel))
        for data, key, channel in steps:
            if data is not None:
                track.append(mido.Message("sysex", data=data))
            track.append(mido.Message("note_on", note=key, channel=channel))
            track.append(mido.Message("note_off", note=key, channel=channel, time=100))
        file = mido.MidiFile(tracks=[track])
        file.save(tmp_path / "tuned.mid")
        score = read_score(tmp_path / "tuned.mid")
        bends: dict[int, float] = {}
        found, held = [], set()
        for event in score.events:
            message = event.message
            if isinstance(message, Setting):
                bends[message.channel] = message.value or 0.0
            elif message.type == "note_on":
                held.add((message.channel, message.note))
                found.append(round(message.note + bends.get(message.channel, 0.0), 4))
            elif message.type == "note_off":
                held.remove((message.channel, message.note))
        assert not held
        return found, score.remarks

    return run


def test_master_tuning_moves_all_notes_from_there_on(pitches):
    up = (*COARSE, 0, 64 + 3)
    assert pitches((None, 60, 0), (up, 60, 0), (None, 62, 5)) == ([60.0, 63.0, 65.0], ())
    quarter = (*FINE, 0, 64 - 16)  # a quarter of a semitone down
    assert pitches((quarter, 60, 0), (None, 60, 1)) == ([59.75, 59.75], ())
    back = (*FINE, 0, 64)
    assert pitches((quarter, 60, 0), (back, 60, 0)) == ([59.75, 60.0], ())


def test_the_scale_is_tuned_note_by_note_on_the_channels_that_are_named(pitches):
    cents = [0, 0, 0, 0, -14, 0, 0, 0, 0, 0, 0, -50]
    assert pitches((scale(cents), 60, 0), (None, 64, 0), (None, 71, 0), (None, 83, 0)) == (
        [60.0, 63.86, 70.5, 82.5],
        (),
    )
    first = scale(cents, (0, 0, 1))
    assert pitches((first, 64, 0), (None, 64, 1)) == ([63.86, 64.0], ())
    fine = scale_14([0.5] + [0.0] * 11)
    assert pitches((fine, 60, 0), (None, 61, 0)) == ([60.5, 61.0], ())


def test_what_is_not_supported_is_remarked(pitches):
    single = (0x7F, 0x7F, 8, 2, 0, 1, 60, 61, 0, 0)
    found, remarks = pitches((single, 60, 0))
    assert found == [60.0]
    assert "single keys" in remarks[0]
    found, remarks = pitches(((*FINE, 0, 64 + 16), 60, 0), wheel=0)
    assert found == [60.0]
    assert "rounded to semitones" in remarks[0]
    assert pitches(((0x41, 16, 66, 18, 64, 0, 127, 0, 65), 60, 0)) == ([60.0], ())  # of one maker
    assert pitches(((0x7E, 0x7F, 8, 8, 3, 127), 60, 0))[0] == [60.0]  # cut short
