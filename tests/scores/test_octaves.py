"""Parts are moved into range as a whole; the tune is played, or those that are asked for."""

import mido
import numpy as np
import pytest
from musicxml_text import note, score

from yehu_server.errors import ScoreError
from yehu_server.scores.chosen_parts import DRUMS
from yehu_server.scores.octaves import NoteSpans, octaves_of
from yehu_server.scores.reading import ReadOptions, percussion_notes, read_any
from yehu_server.scores.tune_part import OVERLAP, melodic_part, take_turns

LOW = [60, 62, 64, 65, 67]
Sounding = tuple[float, float, float]  # begin, end, pitch


def spans_of(parts: list[list[Sounding]]) -> NoteSpans:
    rows = [(*each, each[2], at) for at, part in enumerate(parts) for each in part]
    *columns, part = np.array(rows, float).reshape(-1, 5).T
    return NoteSpans(*columns, part.astype(int))


def sounding(*pitches: float | None, length: float = 1.0, begin: float = 0.0) -> list[Sounding]:
    """Notes one after another, None for a rest."""
    return [
        (begin + length * at, begin + length * (at + 1), pitch)
        for at, pitch in enumerate(pitches)
        if pitch is not None
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
        ([60, 62, 64, 84, 96], [1, 1, 1, 1, 1], "an octave up"),
        ([], [], ""),
    ]
    wrong = []
    for pitches, expected, summary in cases:
        found = octaves_of(spans_of([sounding(*pitches)]), 0.5)
        if [*found.of_notes] != expected or found.summary != summary:
            wrong.append((pitches, found, found.summary))
    assert not wrong


@pytest.fixture
def duet(tmp_path):
    path = tmp_path / "duet.musicxml"
    tune = "".join(note(name, 1) for name in ("C4", "D4", "E4", "G4"))
    path.write_text(score(tune, Viola=note("C5", 4)), encoding="utf-8")
    return path


def keys(played) -> list[int]:
    return [each.key for each in played.notes]


def test_a_written_score_plays_its_first_part_in_one_piece(duet):
    played = read_any(duet)
    assert keys(played) == [72, 74, 76, 79]
    assert played.remarks[0].startswith("plays P1; also there: Viola (--part NAME")
    assert played.remarks[1] == "moved to fit F4 to F6: P1 an octave up"
    assert not played.warnings
    assert keys(read_any(duet, ReadOptions(in_range=False))) == [60, 62, 64, 67]


def test_parts_are_asked_for_by_name_beginning_or_number(duet):
    for asked in ("Viola", "viola", "vio", "2"):
        assert keys(read_any(duet, ReadOptions((asked,)))) == [72]
    assert sorted(keys(read_any(duet, ReadOptions(all_parts=True)))) == [72, 72, 74, 76, 79]
    both = read_any(duet, ReadOptions(all_parts=True))
    assert [part.name for part in both.parts] == ["P1", "Viola"]
    with pytest.raises(ScoreError, match=r"duet\.musicxml: has no part Cello; it has P1, Viola"):
        read_any(duet, ReadOptions(("Cello",)))


def controls(*values: tuple[int, int]) -> list[mido.Message]:
    return [mido.Message("control_change", control=each, value=value) for each, value in values]


def notes(*keys: int, channel: int = 0) -> list[mido.Message]:
    return [
        mido.Message(kind, channel=channel, note=key, time=time)
        for key in keys
        for kind, time in (("note_on", 0), ("note_off", 480))
    ]


@pytest.fixture
def file(tmp_path):
    """Write a MIDI file of tracks, by their names."""

    def write(**tracks: list[mido.Message]):
        file = mido.MidiFile(type=1)
        for name, messages in tracks.items():
            file.add_track(name.strip("_") or None).extend(messages)
        file.save(tmp_path / "tune.mid")
        return tmp_path / "tune.mid"

    return write


def test_tracks_of_a_midi_file_are_moved_each_as_a_whole(file):
    bass, other = notes(40, 43, channel=1), notes(70, channel=2)
    tracks = file(Flute=notes(*LOW), Cello=bass, _=other)
    played = read_any(tracks, ReadOptions(all_parts=True))
    by_channel = [[each.key for each in played.notes if each.channel == n] for n in range(3)]
    assert by_channel == [[72, 74, 76, 77, 79], [76, 79], [70]]
    expected = (
        "moved to fit F4 to F6: Flute an octave up; Cello three octaves up"
        " (a deeper fiddle for Cello: docs/ensemble.md)"
    )
    assert played.remarks == (expected,)
    assert keys(read_any(tracks)) == [72, 74, 76, 77, 79]
    line = "plays Flute; also there: Cello, channel 3 (--part"
    assert read_any(tracks).remarks[0].startswith(line)
    assert keys(read_any(tracks, ReadOptions(("Cello",)))) == [76, 79]


def test_percussion_is_counted_beside_the_part_that_plays_and_is_no_part(file):
    song = file(Lead=notes(70, 72), Pad=notes(66, channel=1), Drums=notes(38, 40, channel=9))
    score = read_any(song, ReadOptions(("Lead",)))
    assert percussion_notes([score]) == 2
    assert [each.key for each in score.notes if each.channel != 9] == [70, 72]
    with pytest.raises(ScoreError, match=r"no part Drums.*--channel 10 plays it"):
        read_any(song, ReadOptions(("Drums",)))


def test_only_what_is_played_counts_in_what_moves(file):
    drums, low = notes(38, 40, channel=9), notes(40, channel=1)
    assert not read_any(file(Drums=drums)).remarks
    song = file(_=[*notes(70, channel=0), *low, *drums])
    only = ReadOptions(all_parts=True, channels={0})
    assert not read_any(song, only).remarks
    assert keys(read_any(song, only)) == [70, 40, 38, 40]
    asked = ReadOptions(all_parts=True, channels={9})
    assert read_any(song, asked).remarks == (DRUMS,)  # and no deeper fiddle for them


def test_channels_of_mpe_are_one_part_whether_the_file_says_it_or_the_player(file):
    tune = [each for n, key in enumerate(LOW) for each in notes(key, channel=n + 1)]
    moved = [key + 12 for key in LOW]
    assert keys(read_any(file(_=[*controls((101, 0), (100, 6), (6, 15)), *tune]))) == moved
    assert keys(read_any(file(_=tune), ReadOptions(is_mpe=True))) == moved


def test_mpe_is_named_where_no_configuration_says_so(file):
    tune = [each for n, key in enumerate(LOW) for each in notes(key, channel=n % 3 + 1)]
    pressed = [mido.Message("aftertouch", value=9, channel=n) for n in (1, 2, 3)]
    for events, is_named in ((pressed + tune, True), (pressed[1:] + tune, False), (tune, False)):
        score = read_any(file(_=events))
        assert any("--mpe plays them as one" in line for line in score.remarks) == is_named
    assert not read_any(file(_=pressed + tune), ReadOptions(is_mpe=True)).remarks[1:]


# ---------------------------------------------------------------- the part with the tune

TUNE = sounding(67, 69, 71, 72, 74, 71, 69, 67)
BASS = sounding(36, 43, 36, 43, 41, 36, 43, 36)
DRONE = sounding(*[67] * 8)
CHORDS = [(at, at + 1.0, 60.0 + step) for at in range(8) for step in (0, 4, 7)]
HELD = [(at, at + 2.0, key) for at in (0, 2, 4, 6) for key in (60.0, 64.0, 67.0, 71.0, 74.0)]
DOUBLE_STOP = [TUNE[0], *TUNE]
WIDE = sounding(40, 60, 80, 100, 40, 60, 80, 100)
BRIEF = sounding(79, 81)


def test_the_tune_is_found_among_what_accompanies_it():
    cases = {
        "alone": ([TUNE], ["a"], 0),
        "first of two": ([TUNE, TUNE], ["a", "b"], 0),
        "over a bass": ([BASS, TUNE], ["a", "b"], 1),
        "beside a drone": ([DRONE, TUNE], ["a", "b"], 1),
        "over chords": ([CHORDS, TUNE], ["a", "b"], 1),
        "named, over held chords": ([HELD, BASS, TUNE], ["Piano", "Bass", "Lead"], 2),
        "over held chords": ([BASS, HELD, TUNE], ["Bass", "Piano", "Violin"], 2),
        "none but chords": ([BASS, HELD], ["Bass", "Piano"], 1),
        "with a double stop": ([DOUBLE_STOP, TUNE], ["a", "b"], 0),
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
        name: found
        for name, (parts, names, expected) in cases.items()
        if (found := melodic_part(names, spans_of(parts))) != expected
    }
    assert not wrong


def test_parts_that_take_turns_are_distinguished_from_parts_that_sound_together():
    assert take_turns(spans_of([TUNE, sounding(60, 62, begin=8.0), sounding(64, begin=20.0)]))
    assert take_turns(spans_of([TUNE, []]))
    assert not take_turns(spans_of([TUNE, sounding(60, 62, begin=7.0)]))


def test_turns_are_those_of_each_pair_of_parts():
    rng = np.random.default_rng(3)

    def together(one, other):
        ways = (min(a[1], b[1]) - max(a[0], b[0]) for a in one for b in other)
        return sum(max(0.0, each) for each in ways)

    outcomes = set()
    for _ in range(200):
        parts = []
        for number in range(3):
            begins, lengths = np.sort(rng.uniform(0, 10, 4)) + 9.0 * number, rng.uniform(0, 2, 4)
            placed = zip(begins, lengths, strict=True)
            parts.append([(at, at + length, 60.0) for at, length in placed])
        sounds = [sum(end - begin for begin, end, _ in part) for part in parts]
        expected = all(
            together(parts[a], parts[b]) <= OVERLAP * min(sounds[a], sounds[b])
            for a, b in ((0, 1), (0, 2), (1, 2))
        )
        assert take_turns(spans_of(parts)) == expected
        outcomes.add(expected)
    assert outcomes == {True, False}
