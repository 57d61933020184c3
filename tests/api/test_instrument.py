"""``yehu.Instrument``: notes, parameters and the bow in; sound and signals out."""

from __future__ import annotations

import math
import pickle

import numpy as np
import pytest
from pitch import cents, pitch_of

import yehu_server as yehu
from yehu_server import YehuError

RATE = 44100


@pytest.fixture
def fiddle() -> yehu.Instrument:
    return yehu.Instrument()


def heard(sound, note: float) -> float:
    """How far the end of a sound is from a MIDI note (cents)."""
    return cents(pitch_of(sound[-8192:], RATE), 440.0 * 2.0 ** ((note - 69.0) / 12.0))


def level(sound) -> float:
    return float(np.sqrt(np.mean(np.square(sound, dtype=np.float64))))


# ---------------------------------------------------------------- notes


@pytest.mark.parametrize(("note", "midi"), [("Bb4", 70), ("F#5-30", 77.7), (72.5, 72.5)])
def test_a_note_sounds_at_its_pitch(fiddle, note, midi):
    fiddle.note_on(note)
    sound = fiddle.play(0.6)
    assert sound.shape == (round(0.6 * RATE),)
    assert sound.dtype == np.float32
    assert heard(sound, midi) == pytest.approx(0.0, abs=12.0)


def test_time_goes_on_only_while_it_plays(fiddle):
    fiddle.note_on("A4")
    assert fiddle.time == 0.0
    fiddle.play(0.25)
    fiddle.play(0.5)
    assert fiddle.time == pytest.approx(0.75, abs=1e-4)


def test_a_note_that_ends_is_no_longer_heard(fiddle):
    fiddle.note_on("G4")
    sounding = fiddle.play(0.5)
    fiddle.note_off("G4")
    fiddle.play(1.0)
    assert level(fiddle.play(0.2)) < 0.01 * level(sounding[-8000:])
    assert fiddle.pitch is None


def test_what_is_asked_for_at_a_time_happens_then(fiddle):
    fiddle.note_on("G4", at=0.3)
    fiddle.note_off(at=0.6)
    sound = fiddle.play(1.2)
    assert not sound[: round(0.3 * RATE)].any()
    assert level(sound[round(0.4 * RATE) : round(0.6 * RATE)]) > 0.003
    assert level(sound[-4000:]) < 1e-3


def test_the_finger_slides_and_bends(fiddle):
    fiddle.note_on("G4")
    fiddle.play(0.3)
    fiddle.slide("B4")
    assert heard(fiddle.play(0.5), 71) == pytest.approx(0.0, abs=12.0)
    fiddle.bend(1.0)
    assert heard(fiddle.play(0.5), 72) == pytest.approx(0.0, abs=12.0)


def test_a_note_that_is_struck_harder_is_louder():
    levels = []
    for velocity in (30, 120):
        fiddle = yehu.Instrument(seed=1)
        fiddle.note_on("G4", velocity)
        levels.append(level(fiddle.play(0.5)))
    assert levels[1] > 2.0 * levels[0]


def test_stop_ends_all_at_once(fiddle):
    fiddle.note_on("G4")
    fiddle.play(0.4)
    fiddle.stop()
    assert np.abs(fiddle.play(0.05)[-100:]).max() < 1e-6


def test_reset_plays_the_same_again(fiddle):
    takes = []
    for _ in range(2):
        fiddle.note_on("D5")
        takes.append(fiddle.play(0.3))
        fiddle.reset()
    np.testing.assert_array_equal(*takes)


# ---------------------------------------------------------------- parameters and the bow


def test_parameters_are_set_held_and_given_back(fiddle):
    fiddle.set("/playing/vibrato", 30.0)
    assert fiddle.get("/playing/vibrato") == 30.0
    fiddle.hold("/bow/position", 0.2)
    fiddle.note_on("G4")
    fiddle.play(0.2)
    assert fiddle.get("/bow/position") == pytest.approx(0.2)
    fiddle.release()
    fiddle.note_on("A4")
    fiddle.play(0.2)
    assert fiddle.get("/bow/position") != pytest.approx(0.2)


def test_settings_and_presets_hold_from_the_beginning():
    fiddle = yehu.Instrument(settings={"/playing/attack": 77.0}, preset="flautando")
    assert fiddle.get("/playing/attack") == 77.0
    assert fiddle.get("/playing/pressure") != yehu.Instrument().get("/playing/pressure")
    fiddle.set("/playing/attack", 20.0)
    assert fiddle.get("/playing/attack") == 77.0  # it is held
    fiddle.reset()
    assert fiddle.get("/playing/attack") == 77.0


def test_the_bow_is_drawn_by_hand(fiddle):
    fiddle.slide("F4")
    fiddle.draw(0.15, 0.5)
    assert heard(fiddle.play(0.8), 65) == pytest.approx(0.0, abs=25.0)
    fiddle.lift()
    fiddle.play(1.0)
    assert level(fiddle.play(0.1)) < 1e-3


def test_a_plucked_string_rings_and_decays(fiddle):
    fiddle.pluck(1.5)
    sound = fiddle.play(0.8)
    begin = round(0.05 * RATE)
    assert level(sound[begin : 2 * begin]) > 5.0 * level(sound[-begin:]) > 0.0


def test_controls_reach_the_model_as_they_are_given(fiddle):
    speed = np.array([0.0, 0.2, -0.1])
    force = np.linspace(0.2, 0.8, 7)
    controls = {"/bow/side": 1.0, "/bow/speed": speed, "/bow/force": force, "/bow/assist": 0.0}
    run = fiddle.record(0.4, controls=controls)
    frames = len(run.arrays["time"])
    share = (np.arange(frames) + 1.0) / frames
    expected = np.interp(share, [0.0, 0.5, 1.0], speed)
    # In straight lines over 64 frames: the corner in the middle may lie within one.
    step = 64.0 / frames
    assert np.abs(run.arrays["bow_velocity"] - expected).max() < 0.6 * step
    expected = np.interp(share, np.linspace(0.0, 1.0, 7), force)
    assert np.abs(run.arrays["bow_force"] - expected).max() < 0.6 * step
    assert np.count_nonzero(np.diff(run.arrays["bow_velocity"])) > 0.95 * frames


# ---------------------------------------------------------------- signals


def test_record_gives_the_sound_of_play_and_every_signal():
    sounds, runs = [], []
    for record in (False, True):
        fiddle = yehu.Instrument(seed=5)
        fiddle.note_on("A4")
        if record:
            runs.append(fiddle.record(0.25, strings_every=50))
        else:
            sounds.append(fiddle.play(0.25))
    arrays, frames = runs[0].arrays, round(0.25 * RATE)
    np.testing.assert_array_equal(arrays["sound"], sounds[0])
    assert arrays["bridge_force"].shape == (frames,)
    assert arrays["finger_position"].shape == (frames, 4)
    assert arrays["contact_force"].shape == (frames, 4, 2)
    assert arrays["string_1"].shape == (math.ceil(frames / 50), len(arrays["x_1"]))
    assert arrays["strings_time"][1] == pytest.approx(50 / RATE)


def test_the_shapes_belong_to_their_moments():
    # A string that is held aside by a pluck is a triangle whose top is where it is plucked, and
    # its height there is the force over both slopes' tension.
    fiddle = yehu.Instrument()
    fiddle.set("/pluck/position", 0.5)
    fiddle.set("/pluck/force", 1.0)
    run = fiddle.record(0.012, strings_every=1)
    shape, x = run.arrays["string_1"], run.arrays["x_1"]
    pulled = int(np.argmax(run.arrays["pluck_force"]))
    # The pull lasts 12 ms, some periods of the string: it follows nearly at rest.
    T, L = fiddle.quantities.string_1.T, fiddle.quantities.bridge_x
    height = 1.0 * 0.5 * L * 0.5 * L / (T * L)
    assert np.abs(shape[pulled]).max() == pytest.approx(height, rel=0.15)
    assert x[np.abs(shape[pulled]).argmax()] == pytest.approx(0.15, abs=0.01)
    assert not shape[0].any()
    assert not shape[:, [0, -1]].any()  # both ends are fixed
    assert np.abs(np.diff(shape, axis=0)).max(axis=1)[100:].min() > 0.0  # each has its own


def test_stereo_has_two_sides_and_a_room():
    fiddle = yehu.Instrument(stereo=True, settings={"/room/pan": -0.8})
    fiddle.note_on("A4")
    sound = fiddle.play(0.5)
    assert sound.shape == (round(0.5 * RATE), 2)
    assert level(sound[:, 0]) > 1.5 * level(sound[:, 1])


def test_stereo_is_heard_in_the_room_and_one_channel_without():
    after = []
    for stereo in (True, False):
        fiddle = yehu.Instrument(preset="hall", stereo=stereo)
        fiddle.note_on("A4")
        fiddle.play(0.5)
        fiddle.note_off()
        after.append(level(fiddle.play(1.0)[-RATE // 4 :]))
    assert after[0] > 20.0 * after[1]


@pytest.mark.parametrize("rate", [48000, 96000.0])
def test_it_is_in_tune_at_other_rates(rate):
    fiddle = yehu.Instrument(rate)
    fiddle.note_on("G4")
    sound = fiddle.play(0.6)
    assert fiddle.sample_rate == rate
    error = cents(pitch_of(sound[-round(0.2 * rate) :], rate), 392.0)
    assert error == pytest.approx(0.0, abs=12.0)


# ---------------------------------------------------------------- what is refused


def test_what_is_wrong_is_told_in_one_line(fiddle):
    mistakes = [
        (lambda f: f.note_on("C3"), "F4 to F6"),
        (lambda f: f.note_on("H4"), "'H4'"),
        (lambda f: f.note_on(None), "None"),
        (lambda f: f.note_on(math.nan), "nan"),
        (lambda f: f.note_on("A4", 200), "velocity"),
        (lambda f: f.slide(30), "F4 to F6"),
        (lambda f: f.set("/bow/forse", 1.0), "/bow/force"),
        (lambda f: f.set("/bow/force", 50.0), "0 to 5 N"),
        (lambda f: f.set("/bow/force", "much"), "/bow/force"),
        (lambda f: f.set(7, 1.0), "address"),
        (lambda f: f.get("/nothing"), "/nothing"),
        (lambda f: f.draw(9.0, 0.5), "/bow/speed"),
        (lambda f: f.pluck(99.0), "/pluck/force"),
        (lambda f: f.play(-1.0), "seconds"),
        (lambda f: f.play(math.inf), "seconds"),
        (lambda f: f.play(1e9), "seconds"),
        (lambda f: f.play(0.1, controls=[1]), "controls"),
        (lambda f: f.play(0.1, controls={"/bow/speed": []}), "/bow/speed"),
        (lambda f: f.play(0.1, controls={"/bow/speed": [0.0, math.nan]}), "/bow/speed"),
        (lambda f: f.play(0.1, controls={"/bow/speed": "fast"}), "/bow/speed"),
        (lambda f: f.play(0.1, controls={"/bow/sped": 0.1}), "/bow/speed"),
        (lambda f: f.record(0.1, strings_every=-1), "strings_every"),
        (lambda f: f.record(3600.0, strings_every=1), "GiB"),
    ]
    for does, names in mistakes:
        with pytest.raises(YehuError) as refused:
            does(fiddle)
        assert names in str(refused.value)
        assert "\n" not in str(refused.value)
    assert fiddle.time == 0.0


def test_the_past_cannot_be_changed(fiddle):
    fiddle.play(0.5)
    with pytest.raises(YehuError, match=r"0\.2 s is over"):
        fiddle.note_on("A4", at=0.2)


def test_a_wrong_option_is_told_in_one_line(subtests):
    for options, names in [
        ({"sample_rate": 8000}, "sample_rate"),
        ({"sample_rate": 44100.5}, "whole"),
        ({"instrument": {"string_1": {"mass": 1.0}}}, "mass"),
        ({"instrument": "/no/such.toml"}, "/no/such.toml"),
        ({"instrument": 7}, "instrument"),
        ({"preset": "louder"}, "louder"),
        ({"preset": 3}, "preset"),
        ({"settings": {"/playing/vibrato": 1e9}}, "cents"),
        ({"settings": ["/playing/vibrato"]}, "settings"),
        ({"tuning": "/no/such.scl"}, "such.scl"),
        ({"practice": "/no/such.json"}, "such.json"),
        ({"a4": 100.0}, "a4"),
        ({"seed": -1}, "seed"),
    ]:
        with subtests.test(options=options, names=names):
            with pytest.raises(YehuError) as refused:
                yehu.Instrument(**options)
            assert names in str(refused.value)
            assert "\n" not in str(refused.value)


def test_an_instrument_of_other_strings_is_tuned(tmp_path):
    file = tmp_path / "mine.toml"
    file.write_text("[string_1]\nsigma_0 = 3.0\n")
    from_file, from_mapping = (
        yehu.Instrument(instrument=each) for each in (file, {"string_1": {"sigma_0": 3.0}})
    )
    assert from_file.quantities == from_mapping.quantities
    assert from_file.quantities.string_1.sigma_0 == 3.0
    from_file.note_on("G4")
    assert heard(from_file.play(0.6), 67) == pytest.approx(0.0, abs=12.0)


@pytest.mark.parametrize("stereo", [False, True])
def test_a_pickled_instrument_goes_on_in_mid_note(stereo):
    fiddle = yehu.Instrument(stereo=stereo, preset="vibrato", seed=2)
    fiddle.note_on("A4")
    fiddle.play(0.2)
    fiddle.slide("C5", at=0.25)
    fiddle.set("/playing/vibrato", 20.0)
    copy = pickle.loads(pickle.dumps(fiddle))  # noqa: S301 - our own
    assert (copy.time, copy.get("/playing/vibrato")) == (fiddle.time, 20.0)
    np.testing.assert_array_equal(copy.play(0.3), fiddle.play(0.3))
    assert copy.pitch == fiddle.pitch
    copy.reset()
    assert copy.time == 0.0
