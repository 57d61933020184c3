"""The player listens: on strings that nobody calibrated for, notes come to their pitch."""

from typing import Any

import numpy as np
import pytest
from pitch import hertz
from sound import rms, run_for

from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.midi.record import clear_held
from yehu_server.core.player.commands import STOP
from yehu_server.params.table import FINGERS
from yehu_server.playing.calibration_store import calibration_for
from yehu_server.playing.options import PlayingOptions
from yehu_server.playing.part_state import Key
from yehu_server.playing.pitch_and_level import cents, pitch_hz
from yehu_server.playing.player import Player

RATE = 44100
NOTES = (66, 71, 74, 75, 78, 80, 82, 84)
DETUNED = (-30.0, 30.0)  # cents


class Play:
    """A player with calibrated fingers, whose strings are then detuned, and what is heard of it."""

    def __init__(self, listening: float = 1.0, detuned: float = 0.0, **values: float) -> None:
        playing = PlayingOptions()
        self.instrument = Instrument(playing.spec(RATE, calibration_for(float(RATE))))
        self.commands: Player = playing.player(self.instrument)
        self.commands.write("/playing/variation", 0.0)
        self.commands.write("/playing/listening", listening)
        self.detune(detuned)
        for name, value in values.items():
            self.commands.write(f"/playing/{name}", value)
        run_for(self.instrument, 0.05)

    def detune(self, by: float) -> None:
        for string in ("inner", "outer"):
            self.commands.write(f"/string/{string}/tuning", by)

    def note(self, note: int, seconds: float, block: int = 0) -> np.ndarray:
        """The sound of a note, whose key stays down."""
        self.commands.note_on(Key(0, note))
        return run_for(self.instrument, seconds, block)

    def rest(self, note: int, seconds: float = 0.4) -> None:
        self.commands.note_off(Key(0, note))
        run_for(self.instrument, seconds)

    @property
    def player(self) -> Any:
        """The player's record."""
        return self.instrument._rig["player"][0]

    def fingers(self) -> list[float]:
        """Where the fingers are, or move to (m)."""
        return [self.instrument.target(f"/finger/{number}/position") for number in FINGERS]


def error(sound: np.ndarray, start_s: float, end_s: float, note: int) -> float:
    """How far a part of a sound is from a note (cents)."""
    part = sound[round(start_s * RATE) : round(end_s * RATE)]
    wanted = hertz(note)
    return cents(pitch_hz(part, RATE, lo=0.6 * wanted, hi=1.7 * wanted), wanted)


@pytest.mark.parametrize("detuned", [0.0, *DETUNED])
def test_a_note_on_detuned_strings_is_brought_to_its_pitch_and_does_not_hunt_for_it(detuned):
    """Each of the notes but one, since which orbit a string is on is chance."""
    right = {}
    for note in NOTES:
        sound = Play(1.0, detuned).note(note, 2.3)
        off = [error(sound, at, at + 0.1, note) for at in np.arange(0.4, 1.1, 0.1)]
        # The last cents take up to a second.
        pitches = [error(sound, at, at + 0.06, note) for at in np.arange(1.2, 2.2, 0.02)]
        right[note] = np.abs(off).max() < 5.0 and np.std(pitches) < 1.0
    assert sum(right.values()) >= len(NOTES) - 1, right


@pytest.mark.parametrize("detuned", DETUNED)
def test_without_listening_it_stays_off_with_the_strings(detuned):
    right = {}
    for note in NOTES:
        play = Play(0.0, detuned)
        sound = play.note(note, 0.3)
        landed = play.fingers()
        sound = np.concatenate([sound, run_for(play.instrument, 0.9)])
        off = [error(sound, at, at + 0.1, note) for at in np.arange(0.4, 1.1, 0.1)]
        right[note] = np.abs(np.subtract(off, detuned)).max() < 9.9
        assert play.fingers() == landed
        assert not play.player["learnt"].any()
        assert not play.player["learnt_pressure_factor"].any()
    assert sum(right.values()) >= len(NOTES) - 1, right


@pytest.mark.parametrize("detuned", DETUNED)
def test_what_was_learnt_makes_the_note_right_from_its_beginning(detuned):
    right = {}
    for note in NOTES[1:]:
        play = Play(1.0, detuned)
        first = play.note(note, 0.6)
        play.rest(note)
        again = play.note(note, 0.6)
        off = [error(again, 0.1, 0.17, note), error(again, 0.4, 0.6, note)]
        was_off = abs(error(first, 0.04, 0.09, note)) > 10.0
        right[note] = np.abs(off).max() < 5.0 and was_off
    assert sum(right.values()) >= len(right) - 1, right


@pytest.mark.parametrize("listening", [1.0, 0.6])
def test_samples_do_not_depend_on_the_sizes_of_blocks(listening):
    sounds = []
    for block in (1, 7, 64, 1000):
        play = Play(listening, -30.0, vibrato=15.0)
        sound = [play.note(71, 0.3, block), play.note(76, 0.2, block)]
        play.commands.write("/playing/bend", 0.4)
        sounds.append(np.concatenate([*sound, run_for(play.instrument, 0.2, block)]))
        assert play.player["learnt"].any()
    assert rms(sounds[0]) > 1e-3
    for sound in sounds[1:]:
        assert np.array_equal(sound, sounds[0])


@pytest.mark.parametrize("note", [66, 70, 76, 84])
@pytest.mark.parametrize("asked", [{"pressure": 1.0}, {"pressure": 1.6}, {"tremolo": 8.0}], ids=str)
def test_the_right_hand_lets_scratching_and_tremolo_be(note, asked):
    play = Play(1.0, 0.0, **asked)
    play.commands.note_on(Key(0, note))
    for _ in range(80):
        run_for(play.instrument, 0.01)
        assert play.player["pressure_factor"] == 1.0
    assert not play.player["learnt_pressure_factor"].any()


@pytest.mark.parametrize("note", [69, 74])
def test_a_string_that_has_no_period_is_leant_on_less_by_a_player_who_listens(note):
    pressures = []
    for listening in (0.0, 1.0):
        play = Play(listening, 0.0, pressure=0.99)  # all but scratching
        play.note(note, 1.0)
        pressures.append(play.instrument.target("/bow/pressure"))
    assert play.player["pressure_factor"] < 0.9  # by a tenth and more, once it is eased
    assert pressures[1] == pytest.approx(pressures[0] * play.player["pressure_factor"])


def test_vibrato_is_not_corrected_away():
    vibrato, pitches = {"vibrato": 30.0, "vibrato_rate": 2.0}, []
    for play in (Play(1.0, -30.0, **vibrato), Play(0.0, 0.0, **vibrato)):
        sound = play.note(74, 1.6)
        pitches.append([error(sound, at, at + 0.03, 74) for at in np.arange(0.6, 1.5, 0.01)])
    assert abs(np.mean(pitches[0])) < 5.0
    assert np.ptp(pitches[0]) == pytest.approx(np.ptp(pitches[1]), rel=0.1)


@pytest.mark.parametrize("note", [65, 72])
@pytest.mark.parametrize("detuned", DETUNED)
def test_an_open_string_is_left_as_it_is_tuned(note, detuned):
    sound = Play(1.0, detuned).note(note, 0.8)
    assert error(sound, 0.5, 0.8, note) == pytest.approx(detuned, abs=15.0)


@pytest.mark.parametrize("is_panic", [True, False])
def test_a_panic_ends_what_sounds_even_if_the_part_has_forgotten_it(is_panic):
    play = Play()
    play.note(70, 0.4)
    clear_held(play.instrument.midi)
    play.commands.stop_sound(is_panic=is_panic)
    sound = run_for(play.instrument, 0.5)
    assert (rms(sound[round(0.1 * RATE) :]) == 0.0) == is_panic
    assert (play.player["held"] == 0) == is_panic
    play.instrument.post(STOP, value=1.0)
    run_for(play.instrument, 0.1)
    assert play.player["held"] == 0
    assert rms(play.note(70, 0.4)[RATE // 5 :]) > 1e-3  # and the next note speaks


def test_a_bow_drawn_by_hand_is_heard_and_left_alone():
    play = Play(detuned=-30.0)
    play.commands.slide(76.0)
    play.commands.draw(0.15, 0.6)
    run_for(play.instrument, 0.1)
    fingers, force = play.fingers(), play.instrument.target("/bow/force")
    run_for(play.instrument, 0.6)
    certainty, slips, error = play.instrument.heard()
    assert certainty > 0.9
    assert slips == pytest.approx(1.0, abs=0.2)
    assert error == pytest.approx(-30.0, abs=15.0)
    assert play.fingers() == fingers
    assert play.instrument.target("/bow/force") == force
