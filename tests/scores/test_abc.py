"""ABC is read as abc2midi plays it, note by note; and what it cannot play, as the standard says."""

from __future__ import annotations

import random
import re
import shutil
import subprocess
from fractions import Fraction
from pathlib import Path

import mido
import pytest

from yehu_server.errors import ScoreError
from yehu_server.scores.abc.reader import read_abc

ABC2MIDI = shutil.which("abc2midi")
TUNES = Path(__file__).parent / "tunes.abc"
ROLLED = Fraction(1, 10)  # quarters, a chord
HEAD = "X:1\nT:A tune\nM:4/4\nL:1/8\nQ:1/4=120\nK:{}\n"
# Typed over the features of the standard: the key, and the music.
TYPED = [
    ("C", "CDEF GABc|"), ("C", "C,D,E,F, c'd'e'f'|"), ("G", "FGAB cdef|"), ("F", "BcBA GFED|"),
    ("D", "F2 C2 f2 c2|"), ("Bb", "BEAd BEAd|"), ("Am", "A2 ^G2 A4|"), ("Em", "EFGA Bcde|"),
    ("Ddor", "DEFG ABcd|"), ("Gmix", "GABc defg|"), ("Ephr", "EFGA Bcde|"), ("Flyd", "FGAB cdef|"),
    ("Bloc", "BCDE FGAB|"), ("F#m", "FGAB cdef|"), ("Ebmaj", "EFGA Bcde|"), ("none", "CDEF|"),
    ("C", "^C2 C2 =C2 C2|C8|"), ("C", "_B2 B2 =B2 B2|B8|"), ("C", "^^F2 __B2 F2 B2|"),
    ("C", "C/2D/2E/F/ G3/2A/2 B4|"), ("C", "C//D//E//F// G2 A2|"), ("C", "C3 D C4|"),
    ("C", "C>D E>F G<A B<c|"), ("C", "C>>D E<<F|"), ("C", "C2>D2 E2<F2|"),
    ("C", "(3CDE (3FGA B4|"), ("C", "(3C2D2E2 F4|"), ("C", "(2CD (4CDEF G2|"),
    ("C", "(5:4:5CDEFG A4|"), ("C", "(3:2:2C2D A4|"), ("C", "(6CDEFGA B4|"),
    ("C", "z2 C2 x2 D2|"), ("C", "C4 Z|D4|".replace(" Z", "z4")), ("C", "Z2|C8|"),
    ("C", "C4-C4|D8|"), ("C", "C8-|C4 D4|"), ("C", "^C8-|C4 C4|"),
    ("C", "|:C4D4|E8:|F8|"), ("C", "C4D4|E8:|F8|"), ("C", "|:C8|[1D8:|[2E8|]F8|"),
    ("C", "|:C8|1D8:|2E8||F8|"), ("C", "|:C8:||:D8:|"), ("C", "|:C8::D8:|"),
    ("C", "[CEG]4 [DF]4|"), ("C", "[C2E2]G2|"), ("C", "(CDEF) (GABc)|"),
    ("C", "[K:G]F4[K:C]F4|"), ("C", "[L:1/4]C D [L:1/16]C4 D4|"), ("C", "[M:3/4]C2D2E2|"),
    ("C", "C D E F\\\nG A B c|"), ("C", "CDEF % comment\nGABc|"), ("C", "CD`EF GA`Bc|"),
]  # fmt: skip


@pytest.fixture
def read(tmp_path):
    def run(text):
        path = tmp_path / "tune.abc"
        path.write_text(text, encoding="utf-8")
        return read_abc(path)

    return run


def notes_of(written) -> list[tuple[Fraction, Fraction, int]]:
    return [
        (note.beat, note.length, round(note.pitch)) for part in written.parts for note in part.notes
    ]


def play(tunes, folder) -> list[Path]:
    """Let abc2midi play tunes; the files that it writes."""
    texts = [text.replace("X:", f"X:{1000 + n}%", 1) for n, text in enumerate(tunes)]
    (folder / "judge.abc").write_text("\n\n".join(texts), encoding="utf-8")
    words = [ABC2MIDI, "judge.abc", "-NGRA", "-NGUI", "-silent"]
    subprocess.run(words, cwd=folder, check=False, capture_output=True, timeout=30)
    return [folder / f"judge{1000 + n}.mid" for n in range(len(tunes))]


def played(path) -> list[tuple[Fraction, Fraction, int]]:
    """The highest notes of such a file: onset, length (quarters), key."""
    file = mido.MidiFile(path)
    found: dict[Fraction, tuple[Fraction, int]] = {}
    for track in file.tracks:
        now, begun = 0, {}
        for message in track:
            now += message.time
            if message.type == "note_on" and message.velocity:
                begun[message.note] = now
            elif message.type in ("note_on", "note_off") and message.note in begun:
                at = Fraction(begun.pop(message.note), file.ticks_per_beat)
                length = Fraction(now, file.ticks_per_beat) - at
                # A chord is rolled from below by 10 ticks for each note.
                at = next((each for each in found if abs(each - at) < ROLLED), at)
                if at not in found or found[at][1] < message.note:
                    found[at] = max(length, found.get(at, (length,))[0]), message.note
    return [(at, *each) for at, each in sorted(found.items())]


def differences(tunes, read, folder) -> list[tuple]:
    wrong = []
    for text, path in zip(tunes, play(tunes, folder), strict=True):
        ours, theirs = notes_of(read(text)), played(path)
        near = len(ours) == len(theirs) and all(
            abs(a[0] - b[0]) < 0.05 and abs(a[1] - b[1]) < 0.05 and a[2] == b[2]
            for a, b in zip(ours, theirs, strict=True)
        )
        if not near:
            wrong.append((text, [*map(str, ours)], [*map(str, theirs)]))
    return wrong


def generated(chance: random.Random) -> str:
    """A tune of whole bars of eight eighths."""
    key = chance.choice(["C", "G", "D", "F", "Bb", "Am", "Em", "Ddor", "Amix"])
    bars = []
    for _ in range(chance.randint(2, 6)):
        beats = [
            chance.choice(["{}{}", "{}2", "{}>{}", "{}<{}", "(3{}{}{}", "z{}", "{}/{}/{}", "^{}{}"])
            for _ in range(4)
        ]
        letters = "CDEFGABcdefg"
        bars.append(" ".join(re_filled(beat, letters, chance) for beat in beats))
    body = "|".join(bars)
    return HEAD.format(key) + (f"|:{body}:|" if chance.random() < 0.5 else f"{body}|") + "\n"


def re_filled(beat: str, letters: str, chance: random.Random) -> str:
    while "{}" in beat:
        beat = beat.replace("{}", chance.choice(letters), 1)
    return beat


@pytest.mark.skipif(ABC2MIDI is None, reason="abc2midi is not installed")
def test_tunes_are_those_of_abc2midi(subtests, read, tmp_path, everything):
    whole = re.split(r"\n(?=X:)", TUNES.read_text(encoding="utf-8"))[1:]
    assert len(whole) == 50
    chance, count = random.Random(20), 200 if everything else 40
    for name, tunes in {
        "typed": [HEAD.format(key) + music for key, music in TYPED],
        "whole": [f"{tune}\n" for tune in whole],
        "generated": [generated(chance) for _ in range(count)],
    }.items():
        with subtests.test(name):
            (tmp_path / name).mkdir()
            assert not differences(tunes, read, tmp_path / name)


def test_marks_voices_parts_and_jumps_are_understood(read):
    written = read(
        'X:1\nT:Two\nM:C\nL:1/4\nK:G\nV:1 name="Flute"\nV:2 name="Yehu"\n'
        "[V:1] !upbow!G .A TB {c}d|(g4|f4)|\n[V:2] !p!D4|Z2|\n"
    )
    flute, yehu = written.parts
    assert (flute.name, yehu.name) == ("Flute", "Yehu")
    marks = [[mark.name for mark in note.marks] for note in flute.notes[:3]]
    assert marks == [["up-bow"], ["staccato"], ["trill"]]
    assert [each.pitch for each in flute.notes[3].before] == [72.0]
    assert [(span.name, span.begin, span.end) for span in flute.spans] == [("slur", 4, 8)]
    assert [key.do for key in written.keys] == ["G"]
    for tune, pitches in (
        ("P:ABA\nM:C\nL:1/1\nK:C\nP:A\nC|\nP:B\nD|\n", [60, 62, 60]),
        ("M:C\nL:1/1\nK:C\nC|!fine!D|E !D.C.!|\n", [60, 62, 64, 60, 62]),
    ):
        assert [note.pitch for note in read(f"X:1\n{tune}").parts[0].notes] == pitches


def test_a_key_may_name_accidentals(read):
    for key, pitches in (
        ("D exp _b ^f", [66.0, 70.0, 72.0]),
        ("D Phr ^f", [66.0, 70.0, 72.0]),
        ("D =c", [66.0, 71.0, 72.0]),
        ("exp ^c", [65.0, 71.0, 73.0]),
        ("F clef=bass middle=b", [65.0, 70.0, 72.0]),  # which are no accidentals
    ):
        notes = read(f"X:1\nL:1/4\nK:{key}\nFBc|").parts[0].notes
        assert [note.pitch for note in notes] == pitches, key


def test_a_file_of_several_tunes_gives_the_one_that_is_asked_for(tmp_path):
    path = tmp_path / "tunes.abc"
    path.write_text("X:1\nK:C\nC\n\nsome text\n\nX:2\nK:C\nD\n", encoding="utf-8")
    assert read_abc(path).remarks == ("tune 1 of 2; --song N takes another",)
    assert [note.pitch for note in read_abc(path, 2).parts[0].notes] == [62.0]
    with pytest.raises(ScoreError, match="there is no tune 3"):
        read_abc(path, 3)
    path.write_text("hello", encoding="utf-8")
    with pytest.raises(ScoreError, match="no tune of ABC"):
        read_abc(path)
