"""A fiddle whose strings are tuned a fifth apart elsewhere than a yehu's, such as an erhu."""

from __future__ import annotations

from dataclasses import asdict

import numpy as np
import pytest
from pitch import cents, hertz, pitch_of

import yehu_server as yehu
from yehu_server import YehuError
from yehu_server.core.physics.quantities import Quantities, override, read_quantities
from yehu_server.playing.calibration_store import calibration_for, read_calibration
from yehu_server.playing.stringing import higher_of, players_a4, range_text
from yehu_server.playing.tuning import EQUAL
from yehu_server.scores.octaves import Sounding, octaves_of
from yehu_server.util.files import shipped_folder

ERHU = shipped_folder("examples") / "erhu.toml"
D4, A4, D6 = 62, 69, 86


def tuned(first, second):
    """Quantities whose strings sound so many semitones higher than a yehu's."""
    usual = Quantities()
    tensions = [
        string.T * 2.0 ** (more / 6.0)
        for string, more in zip(usual.strings, (first, second), strict=True)
    ]
    return override(usual, {f"string_{i + 1}": {"T": T} for i, T in enumerate(tensions)})


def test_how_much_higher_a_fiddle_is_follows_from_its_strings():
    assert higher_of(Quantities()) == 0
    assert higher_of(read_quantities(ERHU)) == D4 - 65
    for semitones in (-7, -1, 2):
        assert higher_of(tuned(semitones, semitones)) == semitones
    assert higher_of(tuned(0.3, -0.3)) == 0  # a yehu out of tune is still one
    assert higher_of(tuned(-2.0, 0.0)) == 0  # and one string by itself says nothing
    assert (range_text(0), range_text(-3)) == ("F4 to F6", "D4 to D6")


@pytest.fixture(scope="module")
def erhu() -> yehu.Instrument:
    return yehu.Instrument(instrument=ERHU)


@pytest.mark.parametrize("note", [D4, 66, A4, 76, D6])
def test_an_erhu_plays_its_notes_in_tune(erhu, note):
    erhu.reset()
    erhu.note_on(note)
    sound = erhu.play(0.7)
    assert cents(pitch_of(sound[-8192:], 44100), hertz(note)) == pytest.approx(0.0, abs=12.0)
    assert erhu.pitch == pytest.approx(note, abs=0.1)


def test_an_erhu_slides_to_the_pitch_that_is_asked_for(erhu):
    erhu.reset()
    erhu.note_on(64)
    erhu.play(0.3)
    erhu.slide(67)
    sound = erhu.play(0.9)
    assert cents(pitch_of(sound[-8192:], 44100), hertz(67)) == pytest.approx(0.0, abs=12.0)


def test_what_an_erhu_does_not_have_is_told_by_its_own_range(erhu):
    with pytest.raises(YehuError, match=r"D4 to D6 \(62 to 86\)"):
        erhu.note_on("F6")
    found = yehu.render([("D4", 0.0, 0.3), ("C4", 0.3, 0.3)], instrument=ERHU, tail=0.0)
    assert "1 note outside D4 to D6, moved by octaves" in found.warnings
    asked = found.asked[1]
    assert asked[np.isfinite(asked)][0] == D4


def test_its_calibration_is_kept_and_read_again():
    quantities = read_quantities(ERHU)
    found = calibration_for(44100.0, quantities)
    assert found.a4 == players_a4(quantities, 440.0) == pytest.approx(440.0 * 2.0 ** (-3 / 12))
    assert found.tensions == pytest.approx([string.T for string in quantities.strings], rel=0.03)
    assert read_calibration(asdict(found), quantities, 440.0) == found


def test_a_tuning_is_moved_as_a_whole():
    moved = EQUAL.moved(-3.0)
    assert [moved.pitch(float(note), 440.0) for note in (62, 69.5)] == [59.0, 66.5]
    assert EQUAL.moved(0.0) is EQUAL
    assert moved.has_octaves


def test_parts_are_moved_into_the_range_of_the_fiddle():
    notes = [Sounding(0.0, 1.0, (62.0,)), Sounding(1.0, 2.0, (74.0,))]
    assert octaves_of(notes, 0.5, -3).of_notes == (0, 0)
    assert octaves_of(notes, 0.5).of_notes == (1, 1)
