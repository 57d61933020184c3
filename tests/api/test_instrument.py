"""``yehu.Instrument``: notes, parameters and the bow in; sound and signals out."""

import math
import pickle

import numpy as np
import pytest
from pitch import cents, pitch_of

import yehu_server as yehu

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


def test_a_note_sounds_at_its_pitch_at_any_rate():
    for note, midi, rate in (
        *(("Bb4", 70, 44100), ("F#5-30", 77.7, 44100), (72.5, 72.5, 44100)),
        *(("G4", 67, 48000), ("G4", 67, 96000.0)),
    ):
        fiddle = yehu.Instrument(rate)
        fiddle.note_on(note)
        sound = fiddle.play(0.6)
        assert fiddle.sample_rate == rate
        assert (sound.shape, sound.dtype) == ((round(0.6 * rate),), np.float32)
        hertz = 440.0 * 2.0 ** ((midi - 69.0) / 12.0)
        error = cents(pitch_of(sound[-round(0.2 * rate) :], rate), hertz)
        assert error == pytest.approx(0.0, abs=12.0), note


def test_what_is_asked_for_at_a_time_happens_then_and_the_same_again_after_a_reset(fiddle, refused):
    takes = []
    for _ in range(2):
        assert fiddle.time == 0.0
        fiddle.note_on("G4", at=0.3)
        fiddle.note_off(at=0.6)
        takes.append(sound := fiddle.play(1.2))
        assert not sound[: round(0.3 * RATE)].any()
        assert level(sound[round(0.4 * RATE) : round(0.6 * RATE)]) > 0.003
        assert level(sound[-4000:]) < 1e-3
        assert fiddle.pitch is None
        fiddle.play(0.25)
        assert fiddle.time == pytest.approx(1.45, abs=1e-4)
        refused("0.2 s is in the past", fiddle.note_on, "A4", at=0.2)
        fiddle.reset()
    np.testing.assert_array_equal(*takes)


def test_the_note_that_is_named_ends(fiddle):
    fiddle.note_on("G4")
    fiddle.note_on("B4")
    fiddle.note_off("B4")
    sounding = fiddle.play(0.6)
    assert fiddle.pitch == pytest.approx(67.0, abs=0.01)
    fiddle.note_off("G4")
    fiddle.play(1.0)
    assert fiddle.pitch is None
    assert level(fiddle.play(0.2)) < 0.01 * level(sounding[-8000:])


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


def test_a_glide_is_the_least_time_of_a_move_that_follows():
    forces = []
    for glide in (0.0, 0.2):
        fiddle = yehu.Instrument()
        fiddle.note_on("G4")
        fiddle.play(0.4)
        fiddle.set("/playing/pressure", 0.5, glide=glide)
        forces.append(fiddle.record(0.3).arrays["bow_force"])
    differs = np.abs(forces[1] - forces[0]) > 1e-3
    assert np.flatnonzero(differs)[-1] / RATE == pytest.approx(0.2, abs=0.02)


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
    playing, recording = (yehu.Instrument(seed=5) for _ in range(2))
    for fiddle in (playing, recording):
        fiddle.note_on("A4")
    arrays = recording.record(0.25, strings_every=50).arrays
    np.testing.assert_array_equal(arrays["sound"], playing.play(0.25))
    frames = len(arrays["sound"])
    assert arrays["bridge_force"].shape == (frames,)
    assert arrays["finger_position"].shape == (frames, 4)
    assert arrays["contact_force"].shape == (frames, 4, 2)
    assert arrays["string_1"].shape == (math.ceil(frames / 50), len(arrays["x_1"]))
    assert arrays["strings_time"][1] == pytest.approx(50 / RATE)


def test_stereo_has_two_sides_and_a_room_and_one_channel_has_none():
    after = []
    for stereo in (True, False):
        fiddle = yehu.Instrument(preset="hall", stereo=stereo)
        fiddle.note_on("A4")
        fiddle.play(0.5)
        fiddle.note_off()
        after.append(level(fiddle.play(1.0)[-RATE // 4 :]))
    assert after[0] > 20.0 * after[1]
    fiddle = yehu.Instrument(stereo=True, settings={"/room/pan": -0.8})
    fiddle.note_on("A4")
    sound = fiddle.play(1.5)
    assert sound.shape == (round(1.5 * RATE), 2)
    assert level(sound[:, 0]) > 1.4 * level(sound[:, 1])  # the player sways, too


def test_velocity_0_ends_a_note_as_in_midi():
    sounds = []
    for end in ("note_off", "note_on"):
        fiddle = yehu.Instrument()
        fiddle.note_on("A4")
        getattr(fiddle, end)("A4", **({"velocity": 0} if end == "note_on" else {}), at=0.2)
        sounds.append(fiddle.play(0.4))
    np.testing.assert_array_equal(*sounds)


# ---------------------------------------------------------------- what is refused


def test_what_is_wrong_is_reported_in_one_line(fiddle, refused):
    play, speed = fiddle.play, "/bow/speed"
    refused("F4 to F6", fiddle.note_on, "C3")
    refused("note: expected a note such as 'A4' or 69, got 'H4'", fiddle.note_on, "H4")
    refused("note: expected a note such as 'A4' or 69, got None", fiddle.note_on, None)
    refused("note: nan is not finite", fiddle.note_on, math.nan)
    refused("velocity: 200 is not within 0 to 127", fiddle.note_on, "A4", 200)
    refused("velocity: 200 is not within 0 to 127", fiddle.note_on, "A4", np.int16(200))
    refused("F4 to F6", fiddle.slide, 30)
    refused("/bow/force", fiddle.set, "/bow/forse", 1.0)
    refused("did you mean /playing/vibrato?", fiddle.set, "/yehu/playing/vibrato", 1.0)
    several = {"preset": ["flautando", "hall"]}
    refused("several with a plus: 'sul-tasto+hall'", yehu.Instrument, **several)
    refused("0 to 5 N", fiddle.set, "/bow/force", 50.0)
    refused("/bow/force", fiddle.set, "/bow/force", "much")
    refused("address", fiddle.set, 7, 1.0)
    refused("/nothing", fiddle.get, "/nothing")
    refused(speed, fiddle.draw, 9.0, 0.5)
    refused("/pluck/force", fiddle.pluck, 99.0)
    for seconds in (-1.0, math.inf, 1e9):
        refused("seconds", play, seconds)
    refused("controls", play, 0.1, controls=[1])
    for wrong in ([], [0.0, math.nan], "fast"):
        refused(speed, play, 0.1, controls={speed: wrong})
    refused(speed, play, 0.1, controls={"/bow/sped": 0.1})
    refused("strings_every", fiddle.record, 0.1, strings_every=-1)
    refused("GiB", fiddle.record, 3600.0, strings_every=1)
    assert fiddle.time == 0.0
    for names, options in (
        ("sample_rate", {"sample_rate": 8000}),
        ("whole", {"sample_rate": 44100.5}),
        ("mass", {"instrument": {"string_1": {"mass": 1.0}}}),
        ("/no/such.toml", {"instrument": "/no/such.toml"}),
        ("instrument", {"instrument": 7}),
        ("louder", {"preset": "louder"}),
        ("preset", {"preset": 3}),
        ("cents", {"settings": {"/playing/vibrato": 1e9}}),
        ("settings", {"settings": ["/playing/vibrato"]}),
        ("such.scl", {"tuning": "/no/such.scl"}),
        ("such.json", {"practice": "/no/such.json"}),
        ("a4", {"a4": 100.0}),
        ("seed", {"seed": -1}),
    ):
        refused(names, yehu.Instrument, **options)


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
