"""Marks as they sound: harmonics and gestures at their pitches, and all as before after."""

from fractions import Fraction

import numpy as np
import pytest
from pitch import cents, frame_pitch, pitch_of

from yehu_server.core.player.note_range import YEHU
from yehu_server.params.articulations import NUMBER
from yehu_server.playing.options import PlayingOptions
from yehu_server.rendering import options as rendering
from yehu_server.rendering.options import Options
from yehu_server.rendering.performance import Performance
from yehu_server.scores.jianpu.reader import parse_jianpu
from yehu_server.scores.written.in_range import moved_part
from yehu_server.scores.written.mark_settings import harmonics_of
from yehu_server.scores.written.notated import Mark, Note, Part, Sign, Tempo, Written
from yehu_server.scores.written.performed import performed

RATE = 44100
FLAGEOLET = Sign(Fraction(0), "articulation", float(NUMBER["flageolet"]))


def played(
    written: Written, phrasing: float = 0.0, seed: int = 0
) -> tuple[np.ndarray, Performance]:
    """The samples of a score, and what played it; the player's own vibrato comes with phrasing."""
    part = rendering.Part(performed(written), PlayingOptions(phrasing=phrasing, seed=seed))
    performance = Performance([part], Options(tail_s=0.0, is_dry=True, is_mono=True))
    return np.concatenate(list(performance.blocks())), performance


def sound(*notes, signs=(), seed=0) -> tuple[np.ndarray, Performance]:
    """That of notes (pitch, marks) of a second each."""
    written = tuple(
        Note(Fraction(n), Fraction(1), float(pitch), tuple(map(Mark, marks)))
        for n, (pitch, *marks) in enumerate(notes)
    )
    return played(Written((Part("", written, (), signs),), (Tempo(Fraction(0), 60.0),)), seed=seed)


def off_cents(samples, at_s, pitch) -> float:
    part = samples[int((at_s + 0.5) * RATE) : int((at_s + 0.9) * RATE)]
    return cents(pitch_of(part, RATE), 440.0 * 2.0 ** ((pitch - 69.0) / 12.0))


def test_a_harmonic_speaks_within_10_cents_of_its_pitch_and_the_note_after_it_as_usual():
    assert harmonics_of(YEHU).keys() == {77.0, 84.0, 91.0}
    for pitch in (77.0, 84.0, 91.0):
        sounds = [sound((pitch, "harmonic"), (67.0,), seed=seed)[0] for seed in range(5)]
        for at_s, wanted in ((0.0, pitch), (1.0, 67.0)):  # F5 jumps to its octave with some seeds
            off = [abs(off_cents(samples, at_s, wanted)) for samples in sounds]
            assert np.median(off) < 10.0, (pitch, off)


def test_under_its_articulation_a_key_is_where_the_finger_touches():
    samples, _ = sound((79,), signs=(FLAGEOLET,))
    assert abs(off_cents(samples, 0.0, 91.0)) < 10.0


def test_all_that_marks_set_is_put_back():
    _, usual = sound((67.0,), (69.0,))
    marks = ("up-bow", "harmonic", "tremolo", "vibrato", "slide-in-up", "outer-string", "spiccato")
    _, played = sound(*((72.0 + n, mark) for n, mark in enumerate(marks)), (67.0, "slide-out-down"),
                      signs=(Sign(Fraction(1), "sul-ponticello"), Sign(Fraction(2), "pizz"),
                             Sign(Fraction(4), "arco"), Sign(Fraction(6), "ordinary")))  # fmt: skip
    before, after = usual.players[0].player.sound(), played.players[0].player.sound()
    moved = {"/playing/note_length", "/playing/velocity", "/playing/pressure"}  # by each note
    assert {a for a in after if after[a] != before[a]} <= moved


@pytest.mark.parametrize(("how", "is_moved"), [("start", True), ("settings", False)])
def test_marks_are_put_back_to_a_preset_and_move_nothing_that_is_held(how, is_moved):
    playing = PlayingOptions(**{how: (("/playing/bow_position", 0.18),)})
    notes = tuple(Note(Fraction(n), Fraction(1), 67.0) for n in range(2))
    signs = (Sign(Fraction(0), "sul-ponticello"), Sign(Fraction(1), "ordinary"))
    score = performed(Written((Part("", notes, (), signs),)))
    performance = Performance([rendering.Part(score, playing)], Options(tail_s=0.0, block=4410))
    places = [performance.player.value("/playing/bow_position") for _ in performance.blocks()]
    assert places[-1] == 0.18
    assert (len({*places}) > 1) == is_moved


# ---------------------------------------------------------------- jianpu


def heard(samples: np.ndarray, at_s: float) -> float:
    """The MIDI note that sounds about a time."""
    middle, half = round(at_s * RATE), RATE // 50
    return 69.0 + 12.0 * np.log2(frame_pitch(samples[middle - half : middle + half], RATE) / 440.0)


def test_a_living_five_sounds_as_its_gesture_moves():
    written = parse_jianpu("4=60 四 活五 - - - 六".encode())
    samples, _ = played(written)
    note = written.parts[0].notes[1]
    shares, steps = zip(*note.contour, strict=True)
    for at_s in np.arange(1.2, 4.9, 0.1):
        # the finger follows within 25 ms
        near = [
            note.pitch + np.interp((at_s - 1.0 + late) / 4.0, shares, steps)
            for late in (-0.025, 0.0, 0.025)
        ]
        assert min(near) - 0.2 < heard(samples, at_s) < max(near) + 0.2, at_s
    assert heard(samples, 5.5) == pytest.approx(69.0, abs=0.15)


def test_a_marked_slide_and_a_sprung_note_are_heard_after_a_leap():
    slid, _ = played(parse_jianpu(b"1=Bb 4=60 6 slideDown 2' -"), 0.5)
    assert 73.5 < heard(slid, 1.06) < 74.2
    assert heard(slid, 1.3) == pytest.approx(72.0, abs=0.15)
    sprung, _ = played(parse_jianpu('1=G 4=60 2 6 ^"跳弓"'.encode()), 0.5)
    assert heard(sprung, 1.06) == pytest.approx(76.0, abs=0.15)


def test_a_harmonic_above_the_highest_stopped_note_is_not_moved():
    highest = max(harmonics_of(YEHU))
    assert highest > YEHU.highest
    for marks, is_moved in (((Mark("harmonic"),), False), ((), True)):
        note = Note(Fraction(0), Fraction(1), highest, marks)
        assert (moved_part(Part("", (note,)))[0].notes != (note,)) == is_moved
