"""``yehu-server score``: what was understood of a written score; and rendering one."""

import json

import pytest
from musicxml_text import dynamics, note, score, slur, technical, tempo, words

from yehu_server.scores.smf.reader import read_score

BARS = (
    tempo(90)
    + dynamics("p")
    + note("G4", 1, technical("up-bow"))
    + note("A4", 1.5)
    + note("C5", 1.5),
    words("with a smile") + note("F+4", 2, slur("start")) + note("G4", 2, slur("stop")),
)


@pytest.fixture
def tune(tmp_path):
    path = tmp_path / "tune.musicxml"
    path.write_text(score(*BARS, title="A tune"), encoding="utf-8")
    return path


def test_a_score_is_shown_note_by_note(command, tune):
    code, out, err = command("score", "show", tune)
    assert (code, err) == (0, "")
    lines = out.splitlines()
    assert lines[0] == "A tune"
    assert "bar 1: 90 quarters a minute" in lines
    assert "part 1: P1, 5 notes, F#4-50 to C5, played where no other is asked for" in lines
    rows = [
        line.split() for line in lines if line[:5].strip().isdigit() or line.startswith("       ")
    ]
    assert rows[0] == ["1", "1", "G4", "1", "[p],", "up-bow"]
    assert rows[2] == ["3", "1/2", "C5", "1", "1/2"]
    assert rows[3][:4] == ["2", "1", "F#4-50", "2"]
    assert lines[-1] == 'not understood: words "with a smile"'


def test_a_dynamic_within_a_held_note_is_shown_at_that_note(command, tmp_path):
    tune = tmp_path / "tune.jianpu"
    tune.write_text("4/4\n5 \\f - - - | 7 - - \\pp -\n", encoding="utf-8")
    lines = command("score", "show", tune)[1].splitlines()
    marks = [line.split()[-4:] for line in lines if line.startswith("    ")]
    assert marks[0][-1] == "[f]"
    assert marks[1] == ["[pp]", "from", "quarter", "3"]


def test_notes_are_named_as_their_key_has_them(command, tmp_path):
    tune = tmp_path / "tune.abc"
    tune.write_text("X:1\nL:1/4\nK:Bb transpose=-2\nBcde|[K:D]c^d=c_c|\n", encoding="utf-8")
    lines = command("score", "show", tune)[1].splitlines()
    assert "bar 1: 1=Ab" in lines
    names = [
        line[17:].split()[0] for line in lines[lines.index("bar 1: 1=Ab") :] if line[:4] == "    "
    ]
    assert names == ["Ab4", "Bb4", "C5", "Db5", "B4", "C#5", "Bb4", "A4"]


def test_a_score_is_shown_as_json(command, tune):
    shown = json.loads(command("score", "show", tune, "--json")[1])
    assert shown["title"] == "A tune"
    assert shown["unknown"] == {'words "with a smile"': 1}
    notes = shown["parts"][0]["notes"]
    assert [each["pitch"] for each in notes] == [67.0, 69.0, 72.0, 65.5, 67.0]
    assert notes[0]["marks"] == [["up-bow", None]]
    assert shown["parts"][0]["spans"] == [["slur", 4.0, 6.0, None]]


def test_what_is_played_is_written_as_midi(command, refused, tune, tmp_path):
    target = tmp_path / "out.mid"
    words = ("score", "show", tune, "--export-midi", target)
    code, _, err = command(*words)
    assert code == 0
    assert "/playing/direction" in err
    assert [each.key for each in read_score(target).notes] == [67, 69, 72, 66, 67]
    assert "exists" in refused(*words)
    assert command(*words, "--overwrite")[0] == 0
    same = ("score", "show", target, "--export-midi", target, "--overwrite")
    assert "would overwrite an input" in refused(*same)
    code, shown, _ = command("score", "show", target)  # it has its parts and notes to show
    assert code == 0
    assert "5 notes, F#4 to C5" in shown
    assert shown.splitlines()[-1].startswith("played, but not shown here: CC 11")
    over = ("score", "show", tune, "--export-midi", tune, "--overwrite")
    assert "would overwrite an input" in refused(*over)


def test_a_score_that_cannot_be_read_is_refused_in_one_line(refused, tmp_path):
    path = tmp_path / "bad.musicxml"
    for text in ("", "<html/>", "<score-partwise/>"):
        path.write_text(text, encoding="utf-8")
        if text != "<score-partwise/>":
            assert "bad.musicxml" in refused("score", "show", path)
        assert "bad.musicxml" in refused("render", path, "-o", tmp_path / "out.wav")
        assert not (tmp_path / "out.wav").exists()


def test_a_score_is_written_in_either_notation_and_says_what_is_left_out(
    command, refused, tune, tmp_path
):
    for name in ("out.musicxml", "out.jianpu"):
        target = tmp_path / name
        code, out, err = command("score", "write", tune, "-o", target)
        assert (code, out) == (0, "")
        assert 'not understood: words "with a smile"' in err
        shown = json.loads(command("score", "show", target, "--json")[1])
        notes = shown["parts"][0]["notes"]
        assert [each["length"] for each in notes] == [1.0, 1.5, 1.5, 2.0, 2.0]
        assert notes[0]["marks"] == [["up-bow", None]]
        assert "exists; --overwrite" in refused("score", "write", tune, "-o", target)
    assert "out.jianpu: written, without pitches between semitones" in err
    assert refused("score", "write", tune, "-o", tmp_path / "out.pdf").endswith(".jianpu, .txt\n")
    midi = refused("score", "write", tune, "-o", tmp_path / "out.mid")
    assert "; for MIDI: score show --export-midi" in midi
    assert "overwrite an input" in refused("score", "write", tune, "-o", tune)
    words = ("score", "write", tune, "-o", tmp_path / "b.jianpu", "--part")
    assert "has no part Flute" in refused(*words, "Flute")
    assert command(*words, "P1")[0] == 0
