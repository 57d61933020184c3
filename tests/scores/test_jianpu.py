"""Jianpu as text: notes, rhythm, repeats, and agreement with jianpu-ly."""

import json
import re
from fractions import Fraction
from pathlib import Path

import pytest

from yehu_server.errors import ScoreError
from yehu_server.scores.jianpu.reader import MAX_BYTES, parse_jianpu, read_jianpu
from yehu_server.scores.smf.reader import read_score
from yehu_server.scores.written.notated import Note, Written
from yehu_server.scores.written.performed import performed

ROOT = Path(__file__).resolve().parents[2]
JUDGED = json.loads(Path(__file__).with_name("judged_jianpu.json").read_text(encoding="utf-8"))


def written(text: str) -> Written:
    return parse_jianpu(text.encode())


def notes(text: str) -> list[Note]:
    return list(written(text).parts[0].notes)


def pitches(text: str) -> list[float]:
    return [note.pitch for note in notes(text)]


def lengths(text: str) -> list[float]:
    return [float(note.length) for note in notes(text)]


# ---------------------------------------------------------------- agreement


def test_notes_are_those_that_jianpu_ly_and_lilypond_write_as_midi(subtests):
    for name in JUDGED:
        with subtests.test(name=name):
            score = written(JUDGED[name]["text"])
            found = sorted(
                [float(note.beat), float(note.length), note.pitch]
                for part in score.parts
                for note in part.notes
            )
            assert [note[2] for note in found] == [note[2] for note in JUDGED[name]["notes"]]
            for mine, theirs in zip(found, JUDGED[name]["notes"], strict=True):
                # their ticks are a 384th of a quarter
                assert mine[:2] == pytest.approx(theirs[:2], abs=1 / 380)
            assert not score.unknown
            assert not score.warnings


def test_the_example_tune_has_the_notes_of_its_midi_file():
    midi = read_score(ROOT / "examples" / "shi_bei_jiu.mid")
    score = read_jianpu(ROOT / "examples" / "shi_bei_jiu.jianpu")
    assert not score.unknown
    assert not score.warnings
    there, here = midi.notes, score.parts[0].notes
    assert [note.pitch for note in here] == [note.key for note in there]
    assert [float(note.beat) for note in here] == [note.beat for note in there]
    played = performed(score).notes
    for mine, theirs in zip(played, there, strict=True):
        assert mine.start_s == pytest.approx(theirs.start_s, abs=1e-5)
        # between strokes the MIDI file leaves 14 ticks, after a phrase 30
        assert mine.length_s == pytest.approx(theirs.length_s, abs=0.045)


# ---------------------------------------------------------------- beyond jianpu-ly's MIDI


PLAYED = {
    # Da capo ends at Fine, and plays only the last ending; of several the first counts.
    "4/4 R{ 1 1 1 1 } Fine 2 2 2 2 DC": [60] * 8 + [62] * 4 + [60] * 4,
    "4/4 R{ 1 - - - } A{ 2 - - - | 3 - - - } Fine 4 - - - DC": [60, 62, 60, 64, 65, 60, 64],
    "4/4 1 - - - DC 2 - - - DC": [60, 60, 62],
    # Dal segno begins at the sign and ends at Fine.
    "4/4 1 - - - Segno 2 - - - Fine 3 - - - DS": [60, 62, 64, 62],
    # The highest note of a chord; octave marks between figures belong as is said.
    "OctavesAfter 135 1'35 5,": [67, 72, 55],
    "OctavesBefore 1'3": [76],
    "OctavesAfter 1'3": [72],
    "'1'3": [76],
    "1,3,": [52],
    "1'3": [72],
    "##1 bb3": [62, 62],
    "> 13": [64],  # the base octave moves no chord
    "1\uff1dF \uff11 \uff12\uff0c \uff13\u2019 \u266f\uff11": [65, 55, 81, 66],  # of full width
}
WARNINGS = {
    "4/4 1 - - - DC 2 - - - DC": "DC",
    "OctavesAfter 135 1'35 5,": "chords, of which the highest note is played",
    "1'3": "octave marks between",
    "1 ~ 2": "ties between different notes",
    "2/4 1 1 |\n1 1 1 |": "bar lines do not fit the metre (first at line 2, column 7)",
    "1 1 1 | 1 |": "",  # no metre is written
    "2/4 1 1. 1 q1": "notes cross a bar line (first at line 1, column 7)",
    # Bars are counted through repeats as they are played.
    **dict.fromkeys(("2/4 R3{ 1 } 1 | 1 1 |", "3/4 R{ 1 1 } A{ 1 | 1 } 1 1 1 |"), ""),
    "1 NextPart 1 -": "parts differ in length",
}


def test_notes_are_played_as_their_signs_say():
    assert {text: pitches(text) for text in PLAYED} == PLAYED


def test_only_what_is_doubtful_is_warned_of():
    for text, warning in WARNINGS.items():
        found = written(text).warnings
        assert bool(found) == bool(warning), text
        assert warning in "".join(found), text
    for text in ("1,3,", ",1,3", ",135'"):
        assert not any("octave marks" in line for line in written(text).warnings), text


def test_notes_last_as_is_written():
    """Also with their dashes, slurs and bar lines in one word; to any beat."""
    score = written("4/4 (1--- 2)|3 -- 4~|4 1 1|")
    assert [float(note.length) for note in score.parts[0].notes] == [4, 1, 3, 2, 1, 1]
    (slur,) = score.parts[0].spans
    assert (slur.name, slur.begin, slur.end) == ("slur", 0, 4)
    assert lengths("2[ q1 q2 ] 4[ q1 q2 q3 q4 ]") == [0.75] * 6  # the time of three or six
    assert lengths("5_ 5__ 5_. 5") == [0.5, 0.25, 0.75, 1.0]
    assert [note.beat for note in notes("3/4 1 - - R*4 2 - -")] == [0, 15]
    assert notes("3[ q1 q1 q1 ] " * 1000)[-1].end == Fraction(1000)


def test_titles_and_names_of_parts_are_kept():
    score = written("title=二泉映月\ninstrument=Yehu\n1 NextPart\ninstrument=Erhu\n1")
    assert (score.title, [part.name for part in score.parts]) == ("二泉映月", ["Yehu", "Erhu"])
    score = written(
        "instrument=Yehu\n1 2 NextPart instrument=Erhu\n1 % NextPart 2\nL: a NextPart 3"
    )
    assert [part.name for part in score.parts] == ["Yehu", "Erhu", ""]
    assert [[note.pitch for note in part.notes] for part in score.parts] == [[60, 62], [60], [64]]
    assert not score.unknown


def test_a_pickup_is_bar_0():
    score = written("3/4,4 5 1 1 1 2 2 2")
    assert [score.place(note.beat)[0] for note in score.parts[0].notes] == [
        "0", "1", "1", "1", "2", "2", "2",
    ]  # fmt: skip


def test_movements_follow_each_other_and_parts_sound_together():
    score = written("4/4 1 - - - NextPart 3 - - - NextScore 2/4 5 - NextPart 6 -")
    assert [[(note.beat, note.pitch) for note in part.notes] for part in score.parts] == [
        [(0, 60.0), (4, 67.0)],
        [(0, 64.0), (4, 69.0)],
    ]
    assert not score.warnings


def test_tempi_are_in_quarters():
    score = written("4=60 1 8=120 1 4.=40 1 2=45 1")
    assert [(tempo.beat, tempo.quarters_per_minute) for tempo in score.tempi] == [
        (0, 60.0), (2 - 1, 60.0), (2, 60.0), (3, 90.0),
    ]  # fmt: skip


def test_texts_of_any_usual_encoding_are_read():
    for encoding in ("utf-8", "utf-8-sig", "utf-16", "gb18030"):
        score = parse_jianpu("title=十杯酒\n1 2 3".encode(encoding))
        assert score.title == "十杯酒"
        assert len(score.warnings) == (encoding == "gb18030")


def test_lyrics_comments_and_lilypond_code_are_no_notes():
    text = "1 2 % 3\nL: 5 5 5\nH:\n一 二\n三\n\nLP:\n1 2 3\n:LP\n3\nchords=c2. g:7\n%% tempo: 4=90"
    score = written(text)
    assert [note.pitch for note in score.parts[0].notes] == [60.0, 62.0, 64.0]
    assert not score.unknown
    assert score.warnings == ("music in LilyPond code (LP:) is not played",)
    assert score.tempi[0].quarters_per_minute == 90.0


def examples_in_the_documentation() -> list[str]:
    """What docs/jianpu.md says that one may write."""
    page = (ROOT / "docs" / "jianpu.md").read_text(encoding="utf-8")
    tables = page.partition("## What is not understood")[0]
    rows = [line for line in tables.splitlines() if line.startswith("| ")]
    codes = [code for row in rows for code in re.findall(r"`([^`]+)`|<code>(.+?)</code>", row)]
    found = [(plain or html).replace("&#124;", "|") for plain, html in codes]
    return [text for text in found if not text.startswith("--")]


def test_what_the_documentation_shows_is_understood(subtests):
    for text in examples_in_the_documentation():
        with subtests.test(text):
            mode = "mode=" if re.fullmatch("[a-z]+u", text) else ""
            assert not written(f"1\n{mode}{text}\n1 1").unknown


# ---------------------------------------------------------------- what cannot be read


def test_words_that_are_not_understood_are_counted_by_name_up_to_some():
    score = written("1 wibble 2 wibble 3 souyin \\wobble ^\"mumble\" x 1''''' ###1")
    counted = {"wibble": 2, "souyin": 1, "\\wobble": 1, '^"mumble"': 1, "1'''''": 1, "###1": 1}
    assert dict(score.unknown) == counted
    assert any("percussion" in warning for warning in score.warnings)
    score = written("1 " + " ".join(f"w{chr(0x4E00 + number)}" for number in range(150)))
    assert len(score.unknown) == 101
    assert score.unknown["other words"] == 50


def test_what_cannot_be_read_is_refused_with_its_place(subtests):
    for text, reason in [
        ("1 2\n R{ 3", "line 2, column 2: has no } that ends it"),
        ("1 }", "line 1, column 3: } without a {"),
        ("1 A{ 2 }", "line 1, column 3: A{ belongs after the } of a repeat"),
        ("3[ q1 q1", "line 1, column 1: has no ] that ends it"),
        ("1=B >>> 7'''", "line 1, column 9: 7''' is beyond any instrument"),
        ("1 >>>>> 1", "line 1, column 3: the base octave is too far"),
        ("4=9999 1", "line 1, column 1: a tempo of 9999 is not within 5 to 1000"),
        ("2/4,1 1", "line 1, column 1: the pickup is longer than the bar"),
        ("R*99999 1", "line 1, column 1: a rest of more than 1000 bars"),
        ("R999{ 1 }", "line 1, column 1: more than 100 times"),
        ("R{ " * 9, "column 25: more than 8 repeats within each other"),
        ("R100{ " * 4 + "1 " + "} " * 4, "with its repeats, has more than"),
        ("hello world", "has no notes of jianpu"),
        ("", "has no notes of jianpu"),
        ("1\0", "is not text"),
        ("99[ 1 ]", "more than 64 notes in a tuplet"),
    ]:
        with subtests.test(text=text, reason=reason):
            with pytest.raises(ScoreError) as refused:
                written(text)
            assert reason in str(refused.value)
            assert "\n" not in str(refused.value)


def test_errors_name_the_file(tmp_path):
    for name, text, reason in [
        ("empty", b"", "is empty"),
        ("none", None, "no such file"),
        ("large", b"1 " * MAX_BYTES, "larger than 1 MiB"),
        ("wrong", b"1 }", "line 1, column 3"),
    ]:
        path = tmp_path / f"{name}.jianpu"
        if text is not None:
            path.write_bytes(text)
        with pytest.raises(ScoreError, match=rf"{name}\.jianpu: {reason}"):
            read_jianpu(path)


def test_the_next_part_keeps_key_and_metre_unless_it_names_its_own():
    score = written("1=G 3/4 1 2 3\nNextPart\n1 R*1 2\nNextPart\n1=D 1")
    assert [[note.pitch for note in part.notes] for part in score.parts] == [
        [55.0, 57.0, 59.0],
        [55.0, 57.0],
        [62.0],
    ]
    assert float(score.parts[1].notes[1].beat) == 4.0
    assert [key.do for key in score.keys] == ["G"]
    told = "a part without a key is in that of the one before, not in C"  # as in jianpu-ly
    assert told in score.warnings
    assert told not in written("1=C 1\nNextPart\n1\nNextPart\n1=D 1").warnings


def test_signs_of_web_pages_are_understood():
    names = {60.0: "1", 62.0: "2", 64.0: "3", 65.0: "4"}
    for text, expected in {
        "|: 1 2 :| 3": "1 2 1 2 3",
        "1 | 2 :| 3": "1 2 1 2 3",
        "1 |: 2 :|: 3 :| 4": "1 2 2 3 3 4",
        "1 :| 2 :| 3 \u2016": "1 1 2 2 3",
        "1 |: 2 | 3": "1 2 3",
        "|:1 2:| 3||": "1 2 1 2 3",
        "1 Fine 2 DC 3": "1 2 1 3",
    }.items():
        score = written(text)
        played = " ".join(names[note.pitch] for note in score.parts[0].notes)
        assert (played, dict(score.unknown)) == (expected, {}), text


def test_the_last_bar_may_leave_what_the_upbeat_has():
    whole = "1=C 3/4,4\n5, | 1 - 3 | 1 - |\n"
    assert performed(written(whole)).warnings == ()
    assert "do not fit" in performed(written(whole + "1 - 3 |\n")).warnings[0]
