"""Playing without notes: a finger slid to a pitch, a bow drawn by hand."""

import numpy as np
import pytest
from hands import HIGH_DB, LOW_DB, Checked, Watched, ideal

from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.core.player.fingering import OpenStrings
from yehu_server.playing.calibration_store import calibration_for
from yehu_server.playing.part_state import Key
from yehu_server.playing.player import Player


def test_the_finger_waits_at_a_pitch_for_the_bow(player, listener):
    assert player.slide(69.5) == 69.5
    assert listener.pitch_at(0, listener.position) == pytest.approx(69.5)
    assert listener.press == 1.5
    assert not listener.of("/bow/side")  # nobody bows yet
    assert player.draw(0.2, 0.7) == (0.2, 0.7)
    assert (listener["/bow/speed"], listener["/bow/force"]) == (0.2, 0.7)
    assert listener["/bow/assist"] == 0.0  # raw newtons
    assert listener["/bow/side"] == 1.0


def test_the_bow_follows_the_finger_to_the_other_string_until_it_is_lifted(player, listener):
    player.draw(0.2, 0.7)
    sides = [listener["/bow/side"]]  # the open inner string: nobody stops one
    for pitch in (76.0, 67.0):
        player.slide(pitch)
        sides.append(listener["/bow/side"])
    player.draw(0.0, 0.0)
    assert [*sides, listener["/bow/side"]] == [1.0, -1.0, 1.0, 0.0]


# ---------------------------------------------------------------- what is told, and how loud it is


def test_the_pitch_drawn_by_hand_is_reported_while_the_bow_is_on_the_string(player):
    """It is where the last note left the finger."""
    player.slide(69.5)
    assert player.pitch is None  # nobody bows yet
    player.draw(0.2, 0.7)
    assert player.pitch == 69.5
    player.slide(76.25)
    assert player.pitch == 76.25
    player.note_on(Key(0, 74))
    player.note_off(Key(0, 74))
    assert player.pitch is None
    player.draw(0.2, 0.7)
    assert player.pitch == 74.0
    player.stop_sound()
    assert player.pitch is None
    player.draw(0.2, 0.7)
    assert player.pitch == 65.0  # nobody stops the string
    player.draw(0.0, 0.0)
    assert player.pitch is None


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
    player = Player(instrument)
    player.write("/body/evenness", evenness)
    out = []
    for pitch in pitches:
        player.slide(float(pitch), frame=instrument.frame)
        player.draw(0.2, 0.6, frame=instrument.frame)
        sound = np.zeros(round(seconds * RATE / len(pitches)), np.float32)
        instrument.process(sound)
        out.append(sound)
    return np.concatenate(out)


def test_a_slide_by_hand_is_evened_out_without_a_click():
    """The balance is a gain, so the two sounds differ by that gain only."""
    path = np.linspace(66.0, 88.0, 60)
    bare, even = (drawn_by_hand(path, 1.0, evenness) for evenness in (0.0, 1.0))
    heard = np.flatnonzero(np.abs(bare) > 1e-3)
    gain_db = 20.0 * np.log10(even[heard] / bare[heard])
    rate_db_per_ms = np.diff(gain_db) / np.diff(heard) * RATE / 1000.0
    assert np.ptp(gain_db) > 10.0
    assert np.abs(rate_db_per_ms).max() < 2.0


# ---------------------------------------------------------------- direct writes among controllers


@pytest.mark.parametrize("port", [0, 1])
def test_a_direct_write_counts_until_the_controller_moves_again(midi, player, port):
    midi.cc(1, 127)
    midi.player.set("/playing/speed", 0.1)
    midi.on(67, port=port)
    assert player.value("/playing/speed") == 0.1
    if port == 0:
        midi.cc(1, 127)
        assert player.value("/playing/speed") == pytest.approx(0.35)


# ---------------------------------------------------------------- the open C string


def test_the_open_string_sounds_when_it_is_wanted():
    for when, pitch, where in [
        ("always", 72.0, ("C", None)),
        ("always", 72.3, ("C", None)),
        ("on-pitch", 72.0, ("C", None)),
        ("on-pitch", 72.3, ("F", 7.3)),
        ("never", 72.0, ("F", 7.0)),
        ("never", 73.0, ("C", 1.0)),
        ("never", 65.0, ("F", None)),  # there is no other way
    ]:
        listener = Watched(calibration=ideal(), open_strings=OpenStrings(when))
        player = Checked(listener)
        player.write("/playing/variation", 0.0)
        player.note_on(Key(0, pitch))
        assert listener.where() == where, (when, pitch)
