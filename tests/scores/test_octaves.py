"""Parts are moved into range as a whole, and those that are asked for are played."""

from __future__ import annotations

import mido
import pytest
from musicxml_text import note, score

from yehu_server.errors import ScoreError
from yehu_server.scores.octaves import Sounding, octaves_of
from yehu_server.scores.reading import How, read_any
from yehu_server.scores.score import DO_BY_FIFTHS, notes_of

LOW = [60, 62, 64, 65, 67]


def sounding(*pitches: float | None) -> list[Sounding]:
    """Notes of one unit each, None for a rest."""
    return [
        Sounding(at, at + 1.0, (pitch,)) for at, pitch in enumerate(pitches) if pitch is not None
    ]


def test_a_tune_is_moved_as_a_whole_then_by_phrases_then_left_to_the_player():
    cases = [
        (LOW, [1] * 5, "an octave up"),
        ([65, 89], [0, 0], ""),
        ([64.4, 70], [1, 1], "an octave up"),
        ([100, 101], [-1, -1], "an octave down"),
        ([41, 43], [2, 2], "two octaves up"),
        # Most fit as they are: the phrase that does not is moved alone.
        ([70, 89, 88, None, 60, None, 70], [0, 0, 0, 1, 0], "1 of 3 phrases by octaves"),
        # One phrase of three octaves: as many as can be fit.
        ([60, 62, 64, 84, 96], [1, 1, 1, 1, 1], "an octave up, 2 notes alone"),
        ([], [], ""),
    ]
    wrong = []
    for pitches, expected, told in cases:
        found = octaves_of(sounding(*pitches), 0.5)
        if [*found.of_notes] != expected or found.told != told:
            wrong.append((pitches, found, found.told))
    assert not wrong


@pytest.fixture
def duet(tmp_path):
    path = tmp_path / "duet.musicxml"
    tune = "".join(note(name, 1) for name in ("C4", "D4", "E4", "G4"))
    path.write_text(score(tune, Viola=note("C5", 4)), encoding="utf-8")
    return path


def keys(played) -> list[int]:
    return [each.key for each in notes_of(played)]


def test_a_written_score_plays_its_first_part_in_one_piece(duet):
    played = read_any(duet)
    assert keys(played) == [72, 74, 76, 79]
    assert played.remarks[0].startswith("plays P1; also there: Viola (--part NAME")
    assert played.remarks[1] == "moved to fit F4 to F6: P1 an octave up"
    assert not played.warnings


def test_parts_are_asked_for_by_name_beginning_or_number(duet):
    for asked in ("Viola", "viola", "vio", "2"):
        assert keys(read_any(duet, How((asked,)))) == [72]
    assert sorted(keys(read_any(duet, How(all_parts=True)))) == [72, 72, 74, 76, 79]
    assert [part.name for part in read_any(duet, How(all_parts=True)).parts] == ["P1", "Viola"]
    with pytest.raises(ScoreError, match=r"duet\.musicxml: has no part Cello; it has P1, Viola"):
        read_any(duet, How(("Cello",)))


def test_keys_stay_where_range_is_not_by_octaves(duet):
    assert keys(read_any(duet, How(in_range=False))) == [60, 62, 64, 67]


@pytest.fixture
def tracks(tmp_path):
    file = mido.MidiFile(type=1)
    for number, name in enumerate(("Flute", "Cello", "")):
        track = file.add_track(name or None)
        for key in (LOW, [40, 43], [70])[number]:
            track.append(mido.Message("note_on", channel=number, note=key))
            track.append(mido.Message("note_off", channel=number, note=key, time=480))
    file.save(tmp_path / "trio.mid")
    return tmp_path / "trio.mid"


def test_tracks_of_a_midi_file_are_moved_each_as_a_whole(tracks):
    played = read_any(tracks, How(all_parts=True))
    by_channel = [[each.key for each in notes_of(played) if each.channel == n] for n in range(3)]
    assert by_channel == [[72, 74, 76, 77, 79], [76, 79], [70]]
    expected = "moved to fit F4 to F6: Flute an octave up; Cello three octaves up"
    assert played.remarks == (expected,)
    assert keys(read_any(tracks)) == [72, 74, 76, 77, 79]
    told = "plays Flute; also there: Cello, channel 3 (--part"
    assert read_any(tracks).remarks[0].startswith(told)
    assert keys(read_any(tracks, How(("Cello",)))) == [76, 79]


def test_a_file_that_says_it_is_mpe_plays_all_its_channels(tmp_path):
    file = mido.MidiFile()
    track = file.add_track()
    for control, value in ((101, 0), (100, 6), (6, 15)):
        track.append(mido.Message("control_change", control=control, value=value))
    for channel, key in ((1, 70), (2, 72)):
        track.append(mido.Message("note_on", channel=channel, note=key))
    for channel, key in ((1, 70), (2, 72)):
        track.append(mido.Message("note_off", channel=channel, note=key, time=480))
    file.save(tmp_path / "mpe.mid")
    assert keys(read_any(tmp_path / "mpe.mid")) == [70, 72]


def test_channels_of_mpe_are_one_part(tmp_path):
    file = mido.MidiFile()
    track = file.add_track()
    for number, key in enumerate(LOW):
        track.append(mido.Message("note_on", channel=number + 1, note=key))
        track.append(mido.Message("note_off", channel=number + 1, note=key, time=480))
    file.save(tmp_path / "mpe.mid")
    assert keys(read_any(tmp_path / "mpe.mid", How(is_mpe=True))) == [key + 12 for key in LOW]


def test_a_file_with_controllers_alone_says_that_it_is_silent(tmp_path):
    file = mido.MidiFile()
    file.add_track().append(mido.Message("control_change", control=1, value=3))
    file.save(tmp_path / "knob.mid")
    assert read_any(tmp_path / "knob.mid").remarks == (
        "has controllers and no note: nothing sounds",
    )


def test_coarse_tuning_counts_for_the_range(tmp_path):
    file = mido.MidiFile()
    track = file.add_track()
    for control, value in ((101, 0), (100, 2), (6, 76)):
        track.append(mido.Message("control_change", control=control, value=value))
    for key in LOW:
        track.append(mido.Message("note_on", note=key))
        track.append(mido.Message("note_off", note=key, time=480))
    file.save(tmp_path / "tuned.mid")
    assert keys(read_any(tmp_path / "tuned.mid")) == LOW


def test_keys_have_the_names_of_their_do():
    assert (DO_BY_FIFTHS[0], DO_BY_FIFTHS[1], DO_BY_FIFTHS[-1]) == ("C", "G", "F")
