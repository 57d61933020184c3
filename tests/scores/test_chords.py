"""Of notes that begin together a player has the highest, whatever the order of the events."""

from itertools import permutations

import pytest
from midi_files import midi_file, notes

from yehu_server.playing.options import PlayingOptions
from yehu_server.rendering.options import Part
from yehu_server.scores.reading import ReadOptions, read_any
from yehu_server.scores.transcription import read_as_written

PLAIN = PlayingOptions(phrasing=0.0, rubato=0.0)


@pytest.fixture
def played(tmp_path):
    """The keys that are played, and how many lower notes are not; also of the written score."""

    def run(*events, playing: PlayingOptions = PLAIN):
        path = midi_file(tmp_path / "chords.mid", notes(*events))
        part = Part.shaped([read_any(path)], playing)
        keys = [note.key for note in part.score.notes]
        if playing is PLAIN:
            written, lost = read_as_written(path)
            shown = [note.pitch for note in written.parts[0].notes]
            assert (shown, lost.get("lower notes of chords", 0)) == (keys, part.lower_notes)
        return keys, part.lower_notes

    return run


@pytest.mark.parametrize("strum_s", [0.0, 0.012])
def test_the_highest_of_a_chord_plays_whatever_the_order(played, strum_s):
    for order in permutations((67, 71, 74)):
        chord = [(strum_s * at, 0.9 - strum_s * at, key, 80) for at, key in enumerate(order)]
        assert played(*chord, (1.0, 0.9, 76, 80)) == ([74, 76], 2)


def test_of_two_lines_the_upper_plays(played):
    upper = [(0.5 * at, 0.48, key, 80) for at, key in enumerate((76, 77, 79))]
    lower = [(0.5 * at, 0.48, key, 80) for at, key in enumerate((67, 69, 71))]
    assert played(*lower, *upper) == ([76, 77, 79], 3)


def test_chords_are_moved_by_what_their_highest_notes_need(tmp_path):
    def held(*keys, at=0.0, length=0.5):
        return [(at, length, key, 80) for key in keys]

    def read(*events, playing: PlayingOptions = PLAIN):
        path = midi_file(tmp_path / "chords.mid", notes(*events))
        score = read_any(path, ReadOptions.by(playing, all_parts=False))
        return [note.key for note in Part.shaped([score], playing).score.notes], score.remarks

    up = ("moved to fit F4 to F6: an octave up",)
    tune = [note for at, key in enumerate((72, 74, 76, 77)) for note in held(key, at=at / 2)]
    for events, keys, remarks in (
        (tune + held(48, 52, 55, length=2.0), [72, 74, 76, 77], ()),
        (held(60, 64, 72) + held(62, 65, 74, at=0.5), [72, 74], ()),
        (held(60, 64, 79), [79], ()),
        (held(60, 63) + held(62, at=0.5), [75, 74], up),
    ):
        assert read(*events) == (keys, remarks)
    section = PlayingOptions(phrasing=0.0, rubato=0.0, settings=(("/playing/section", 3.0),))
    assert read(*held(60, 63, 74), playing=section) == ([72, 75, 86], up)


def test_grace_notes_and_legato_are_no_chords(played):
    grace = ((0.0, 0.027, 69, 80), (0.025, 0.5, 67, 80))
    keys, lower = played(*grace, (0.5, 0.5, 72, 80), playing=PlayingOptions(phrasing=0.5))
    assert (keys, lower) == ([69, 67, 72], 0)


def test_a_section_has_all_notes_of_a_chord(played):
    section = PlayingOptions(phrasing=0.0, settings=(("/playing/section", 3.0),))
    assert played((0.0, 1.0, 67, 80), (0.0, 1.0, 74, 80), playing=section) == ([67, 74], 0)
