"""Two-stringed fiddles whose strings are tuned otherwise than a yehu's, such as an erhu."""

from dataclasses import asdict

import numpy as np
import pytest
from pitch import cents, hertz, pitch_of

import yehu_server as yehu
from yehu_lab.practising.passages import SearchedNote, pitches_near_notes, stops_of
from yehu_server import YehuError
from yehu_server.core.physics.default_quantities import Quantities, override, read_quantities
from yehu_server.core.player.note_range import YEHU, NoteRange
from yehu_server.core.player.note_tables import PITCHES
from yehu_server.errors import ParameterError
from yehu_server.playing.bowing_tables import bowing_table_beside, read_bowing_table
from yehu_server.playing.calibration_store import calibration_for, read_calibration
from yehu_server.playing.stringing import notes_of, range_text
from yehu_server.util.files import shipped_folder

ERHU = shipped_folder("examples") / "erhu.toml"
D4, A4, A6 = 62, 69, 93
RATE = 44100


def tuned(first, second):
    """Quantities whose strings sound so many semitones higher than a yehu's."""
    usual = Quantities()
    tensions = [
        string.T * 2.0 ** (more / 6.0)
        for string, more in zip(usual.strings, (first, second), strict=True)
    ]
    return override(usual, {f"string_{i + 1}": {"T": T} for i, T in enumerate(tensions)})


def test_what_a_fiddle_is_tuned_to_follows_from_its_strings():
    known = {
        (0.0, 0.0): (65, 72),
        (0.3, -0.3): (65, 72),  # a yehu out of tune is still one
        (0.8, 0.0): (65, 72),
        (-7.0, -7.0): (58, 65),
        (2.0, 0.0): (67, 72),  # in fourths
        (0.0, 5.0): (65, 77),
    }
    found = {moved: notes_of(tuned(*moved)).open_notes for moved in known}
    assert found == known
    assert notes_of(Quantities()) == YEHU
    erhu = notes_of(read_quantities(ERHU))
    assert (range_text(YEHU), range_text(erhu)) == ("F4 to F6", "D4 to A6")
    for strings in ((9.0, 0.0), (0.0, 8.0)):
        with pytest.raises(ParameterError, match="expected the second higher than the first"):
            notes_of(tuned(*strings))
    with pytest.raises(ParameterError, match="at most 3 octaves from a yehu's"):
        notes_of(override(tuned(7.0, 7.0), {"bridge_x": 0.05}))
    with pytest.raises(ParameterError, match=r"stopped up to F6, which is above .* D6"):
        notes_of(override(Quantities(), {"string_1": {"reach": 24}, "string_2": {"reach": 14}}))


def test_a_file_may_be_based_on_another_and_not_on_itself(tmp_path):
    (tmp_path / "a.toml").write_text(f'base = "{ERHU}"\nbridge_x = 0.38\n')
    (tmp_path / "b.toml").write_text('base = "b.toml"\n')
    found = read_quantities(tmp_path / "a.toml")
    assert (found.bridge_x, found.string_2) == (0.38, read_quantities(ERHU).string_2)
    with pytest.raises(ParameterError, match="are based on another"):
        read_quantities(tmp_path / "b.toml")


def off_in_octaves(sound, note):
    """How far a sound is from a note, in any octave: the body hardly radiates D4's fundamental."""
    off = cents(pitch_of(sound[-8192:], RATE), hertz(note))
    return off - 1200.0 * round(off / 1200.0)


@pytest.fixture(scope="module")
def erhu() -> yehu.Instrument:
    return yehu.Instrument(instrument=ERHU)


def test_an_erhu_plays_its_notes_in_tune(erhu):
    for note in (D4, 66, A4, 76, 86, A6):
        erhu.reset()
        erhu.note_on(note)
        assert off_in_octaves(erhu.play(0.7), note) == pytest.approx(0.0, abs=12.0), note
        assert erhu.pitch == pytest.approx(note, abs=0.1)


def test_notes_above_those_of_a_yehu_begin_in_tune(erhu):
    """The ear corrects within a quarter of a second; before it, the tables have to be right."""
    for note in (87, 91, A6):
        erhu.reset()
        erhu.set("/playing/variation", 0.0)
        erhu.note_on(note)
        sound = erhu.play(0.17)
        off = cents(pitch_of(sound[-3087:], RATE), hertz(note))
        assert off == pytest.approx(0.0, abs=8.0), note


def test_what_an_erhu_does_not_have_is_reported_by_its_own_range(erhu):
    with pytest.raises(YehuError, match=r"D4 to A6 \(62 to 93\)"):
        erhu.note_on("C7")
    found = yehu.render([("D4", 0.0, 0.3), ("C4", 0.3, 0.3)], instrument=ERHU, tail=0.0)
    assert "1 note outside D4 to A6, moved by octaves" in found.warnings
    asked = found.asked[1]
    assert asked[np.isfinite(asked)][0] == D4


def test_its_calibration_is_kept_and_read_again():
    quantities, bowing = read_quantities(ERHU), read_bowing_table(bowing_table_beside(ERHU))
    found = calibration_for(float(RATE), quantities, bowing=bowing)
    assert (found.a4, found.open_notes) == (440.0, (D4, A4))
    assert found.tensions == pytest.approx([string.T for string in quantities.strings], rel=0.03)
    assert read_calibration(asdict(found), quantities, 440.0) == found


def test_what_is_practised_are_notes_that_the_fiddle_has():
    search = SearchedNote(0, 70, 0, np.zeros(6), notes=NoteRange((67, 72)))
    assert (search.sounds, search.is_high_on_inner) == (72, True)
    assert not SearchedNote(0, 70, 0, np.zeros(6)).is_high_on_inner
    assert PITCHES[0][0] == 66.0  # the tables are of a yehu's names
    for reaches in ((11.5, 24.0), (8.5, 20.5), (9.0, 7.0), (12.0, 24.9)):
        for open_notes in ((65, 72), (62, 69), (67, 72)):
            notes = NoteRange(open_notes, reaches)
            known = pitches_near_notes(float, notes)
            sounding = {
                SearchedNote(string, note, 0, np.zeros(6), notes=notes).sounds
                for string, note in stops_of(notes)
            }
            assert {notes.lowest, notes.highest} <= sounding <= known.keys(), (open_notes, reaches)
