"""Playing without notes: a finger slid to a pitch, a bow drawn by hand."""

from __future__ import annotations

import mido
import numpy as np
import pytest
from hands import HIGH_DB, LOW_DB, Checked, Watched, ideal

from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.core.physics.quantities import Quantities
from yehu_server.core.player.fingering import OpenStrings
from yehu_server.playing.calibration_store import calibration_for
from yehu_server.playing.midi_poster import MidiPoster
from yehu_server.playing.pitch_and_level import a_weighted_db
from yehu_server.playing.wishes import Key, WishPoster


def test_the_finger_waits_at_a_pitch_for_the_bow(player, listener):
    assert player.slide(69.5) == 69.5
    assert listener.pitch_at(0, listener.position) == pytest.approx(69.5)
    assert listener.press == 1.5
    assert not listener.of("/bow/side")  # nobody bows yet
    assert player.draw(0.2, 0.7) == (0.2, 0.7)
    assert (listener["/bow/speed"], listener["/bow/force"]) == (0.2, 0.7)
    assert listener["/bow/assist"] == 0.0  # raw newtons
    assert listener["/bow/side"] == 1.0


def test_the_bow_follows_the_finger_to_the_other_string(player, listener):
    player.draw(0.2, 0.7)
    player.slide(76.0)
    assert listener["/bow/side"] == -1.0
    player.slide(67.0)
    assert listener["/bow/side"] == 1.0


def test_a_bow_drawn_by_hand_without_a_finger_plays_the_open_inner_string(player, listener):
    player.draw(0.2, 0.7)
    assert listener["/bow/side"] == 1.0


def test_no_speed_and_no_force_lift_the_bow(player, listener):
    player.draw(0.2, 0.7)
    player.draw(0.0, 0.0)
    assert listener["/bow/side"] == 0.0


def test_lifting_touches_only_a_bow_drawn_by_hand(player, listener):
    player.note_on(Key(0, 67))
    moves = len(listener.moves)
    player.lift()
    assert len(listener.moves) == moves
    player.note_off(Key(0, 67))
    player.draw(0.2, 0.7)
    player.lift()
    assert (listener["/bow/speed"], listener["/bow/side"]) == (0.0, 0.0)


def test_a_note_takes_the_bow_back(player, listener):
    player.draw(0.2, 0.7)
    player.note_on(Key(0, 74))
    assert listener["/bow/assist"] == 1.0
    assert listener.where() == ("C", 2.0)


def test_a_sounding_note_slides_to_a_pitch(player, listener):
    player.note_on(Key(0, 67))
    player.slide(68.25)
    assert listener.where() == ("F", 3.25)
    player.note_off(Key(0, 67))
    assert listener["/bow/speed"] == 0.0


def test_a_pitch_beyond_the_instrument_is_played_as_the_nearest(player):
    assert player.slide(20.0) == 65.0
    assert player.slide(120.0) == 89.0


def test_notes_may_lie_between_the_keys(player, listener):
    player.note_on(Key(0, 67.5))
    assert listener.where() == ("F", 2.5)
    player.note_off(Key(0, 67.5))
    assert listener["/bow/speed"] == 0.0


# ---------------------------------------------------------------- what is told, and how loud it is


def test_the_pitch_drawn_by_hand_is_told_while_the_bow_is_on_the_string(player):
    player.slide(69.5)
    assert player.pitch is None  # nobody bows yet
    player.draw(0.2, 0.7)
    assert player.pitch == 69.5
    player.slide(76.25)
    assert player.pitch == 76.25
    player.draw(0.0, 0.0)
    assert player.pitch is None


def test_the_pitch_by_hand_is_where_the_last_note_left_the_finger(player):
    player.draw(0.2, 0.7)
    assert player.pitch == 65.0  # nobody stopped the string
    player.note_on(Key(0, 74))
    player.note_off(Key(0, 74))
    assert player.pitch is None
    player.draw(0.2, 0.7)
    assert player.pitch == 74.0
    player.stop_sound()
    assert player.pitch is None
    player.draw(0.2, 0.7)
    assert player.pitch == 65.0


def test_what_is_drawn_by_hand_is_as_loud_as_the_rest(player, listener):
    player.slide(76.0)
    player.draw(0.2, 0.7)
    assert listener["/output/balance"] == pytest.approx(HIGH_DB * 0.9)
    player.slide(67.0)
    assert listener["/output/balance"] == pytest.approx(LOW_DB * 0.9)
    player.slide(76.0)
    player.write("/body/evenness", 0.5)
    assert listener["/output/balance"] == pytest.approx(HIGH_DB * 0.5)
    assert all(move.ramp_ms > 0.0 for move in listener.of("/output/balance"))


RATE = 44100.0
CALIBRATION = calibration_for(RATE)


def drawn_by_hand(pitches, seconds: float, evenness: float) -> np.ndarray:
    """The sound of a bow drawn by hand while the finger goes through pitches."""
    tuned = CALIBRATION.tuned(Quantities())
    instrument = Instrument(InstrumentSpec(RATE, tuned, calibration=CALIBRATION))
    player = WishPoster(instrument)
    player.write("/body/evenness", evenness)
    out = []
    for pitch in pitches:
        player.slide(float(pitch), frame=instrument.frame)
        player.draw(0.2, 0.6, frame=instrument.frame)
        sound = np.zeros(round(seconds * RATE / len(pitches)), np.float32)
        instrument.process(sound)
        out.append(sound)
    return np.concatenate(out)


def test_by_hand_the_loudest_note_is_not_much_louder_than_the_softest():
    """Notes are bowed as each needs; by hand nothing does that, so the loudness is less even."""

    def spread(evenness: float) -> float:
        sounds = [drawn_by_hand([pitch], 0.6, evenness) for pitch in (66, 73, 78)]
        levels = [a_weighted_db(sound[-11025:], RATE) for sound in sounds]
        return max(levels) - min(levels)

    assert spread(0.0) > 15.0
    assert spread(1.0) < 8.0


def test_a_slide_by_hand_is_evened_out_without_a_click():
    """The balance is a gain, so the two sounds differ by that gain only."""
    path = np.linspace(66.0, 88.0, 60)
    bare, even = (drawn_by_hand(path, 1.0, evenness) for evenness in (0.0, 1.0))
    heard = np.flatnonzero(np.abs(bare) > 1e-3)
    gain_db = 20.0 * np.log10(even[heard] / bare[heard])
    rate_db_per_ms = np.diff(gain_db) / np.diff(heard) * RATE / 1000.0
    assert np.ptp(gain_db) > 10.0
    assert np.abs(rate_db_per_ms).max() < 2.0


# ---------------------------------------------------------------- several ports


def on(player: MidiPoster, note: int, port: int) -> None:
    player.receive(mido.Message("note_on", note=note, velocity=80), port=port)


@pytest.fixture
def ports(player, mapping) -> MidiPoster:
    return MidiPoster(player, mapping)


# ---------------------------------------------------------------- direct writes among controllers


def test_a_direct_write_counts_until_the_controller_moves_again(ports, player):
    ports.receive(mido.Message("control_change", control=1, value=127))
    ports.write("/playing/speed", 0.1)
    on(ports, 67, port=0)
    assert player.value("/playing/speed") == 0.1
    ports.receive(mido.Message("control_change", control=1, value=127))
    assert player.value("/playing/speed") == pytest.approx(0.35)


def test_a_direct_write_reaches_notes_of_other_ports(ports, player):
    ports.receive(mido.Message("control_change", control=1, value=127), port=0)
    ports.write("/playing/speed", 0.1)
    on(ports, 67, port=1)
    assert player.value("/playing/speed") == 0.1


# ---------------------------------------------------------------- the open C string


@pytest.mark.parametrize(
    ("when", "pitch", "where"),
    [
        ("always", 72.0, ("C", None)),
        ("always", 72.3, ("C", None)),
        ("on-pitch", 72.0, ("C", None)),
        ("on-pitch", 72.3, ("F", 7.3)),
        ("never", 72.0, ("F", 7.0)),
        ("never", 73.0, ("C", 1.0)),
        ("never", 65.0, ("F", None)),  # there is no other way
    ],
)
def test_the_open_string_sounds_when_it_is_wanted(when, pitch, where):
    listener = Watched(calibration=ideal(), open_strings=OpenStrings(when))
    player = Checked(listener)
    player.write("/playing/variation", 0.0)
    player.note_on(Key(0, pitch))
    assert listener.where() == where
