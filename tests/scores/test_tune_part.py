"""The part that plays where none is asked for is the one that carries the tune."""

from __future__ import annotations

from yehu_server.core.player.note_range import NoteRange
from yehu_server.scores.octaves import Sounding
from yehu_server.scores.tune_part import melodic_part, take_turns


def line(*pitches: float, length: float = 1.0, begin: float = 0.0) -> list[Sounding]:
    places = (begin + length * at for at in range(len(pitches)))
    return [Sounding(at, at + length, (pitch,)) for at, pitch in zip(places, pitches, strict=True)]


TUNE = line(67, 69, 71, 72, 74, 71, 69, 67)
BASS = line(36, 43, 36, 43, 41, 36, 43, 36)
DRONE = line(*[67] * 8)
CHORDS = [Sounding(at, at + 1.0, (60.0 + step,)) for at in range(8) for step in (0, 4, 7)]
WIDE = line(40, 60, 80, 100, 40, 60, 80, 100)
BRIEF = line(79, 81)


def test_the_tune_is_found_among_what_accompanies_it():
    cases = {
        "alone": ([TUNE], ["a"], 0),
        "first of two": ([TUNE, TUNE], ["a", "b"], 0),
        "over a bass": ([BASS, TUNE], ["a", "b"], 1),
        "beside a drone": ([DRONE, TUNE], ["a", "b"], 1),
        "over chords": ([CHORDS, TUNE], ["a", "b"], 1),
        "after a few notes": ([BRIEF, TUNE], ["a", "b"], 1),
        "beside leaps": ([WIDE, TUNE], ["a", "b"], 1),
        "named": ([TUNE, TUNE], ["Flute", "Lead Vocal"], 1),
        "named in Chinese": ([TUNE, TUNE], ["甲", "主旋律"], 1),
        "voice of a staff": ([TUNE, TUNE], ["Piano", "Piano, voice 2"], 0),
        "named as accompaniment": ([TUNE, TUNE], ["Chords", "b"], 1),
        "none is one": ([[], BASS, DRONE], ["a", "b", "c"], 1),
        "nothing": ([[], []], ["a", "b"], None),
    }
    wrong = {
        name: melodic_part(names, parts)
        for name, (parts, names, expected) in cases.items()
        if melodic_part(names, parts) != expected
    }
    assert not wrong


def test_a_tune_fits_the_instrument_that_plays_it():
    erhu = NoteRange((62, 69), (32.0, 32.0))
    wide = line(62, 69, 76, 83, 90, 97, 101, 97)
    assert melodic_part(["a", "b"], [wide, TUNE]) == 1
    assert melodic_part(["a", "b"], [wide, TUNE], erhu) == 0


def test_parts_that_take_turns_are_told_from_parts_that_sound_together():
    assert take_turns([TUNE, line(60, 62, begin=8.0), line(64, begin=20.0)])
    assert not take_turns([TUNE, line(60, 62, begin=7.0)])
    assert take_turns([TUNE, []])
