"""ABC is read as abc2midi plays it, note by note; and what it cannot play, as the standard says."""

import random
import re
import shutil
import subprocess
from fractions import Fraction
from pathlib import Path

import mido
import pytest

from yehu_server.errors import ScoreError
from yehu_server.scores.abc import keywords
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
# One by one: abc2midi keeps the octave of one tune for the next.
CLEFS = [
    ("C clef=treble-8", "c4 [K:G]f4|"), ("C", "C2 [K:clef=treble+8]C2 [K:clef=treble]C4|"),
    ("C clef=G2-8", "c8|"), ("C clef=bass middle=d", "C8|"), ("C octave=-1", "c4 [K:F]B4|"),
    ("C transpose=-2", "c4 [K:G]f4|"), ("C clef=treble-8 octave=0", "c4 [K:F]b4|"),
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
    with subtests.test("clefs"):
        tunes = [HEAD.format(key) + music for key, music in CLEFS]
        assert not [each for tune in tunes for each in differences([tune], read, tmp_path)]


def edited(tune: str, chance: random.Random) -> str:
    """A tune with one more field, of those that change where its notes sound, or with a text."""
    lines = tune.rstrip("\n").split("\n")
    head = next(at for at, line in enumerate(lines) if line.startswith("K:"))
    body = [at for at in range(head + 1, len(lines)) if not re.match(r"\w:|%", lines[at])]
    at, key = chance.choice(body), chance.choice(["G", "Am", "Bb", "Ddor"])
    says = chance.choice(["clef=treble-8", "treble+8", "bass", "octave=1", "transpose=-2"])
    kind = chance.choice(["key", "voice", "head", "inline", "change", "text", "spread"])
    if kind == "key":
        lines[head] += f" {says}"
    elif kind == "voice":
        lines.insert(head + 1, f"V:1 {says}")
    elif kind == "head":
        lines[head : head + 1] = [f"V:1 {says}", lines[head], "V:1"]
    elif kind == "inline":
        lines[head] += f" {says}"
        lines[at] = f"[K:{key}]{lines[at]}"
    elif kind == "change":
        lines[head] += f" {says}"
        lines.insert(at, f"K:{key}")
    elif kind == "text":
        lines[at:at] = ["%%begintext", "a bad egg", "%%endtext"]
    else:
        lines.insert(head, "%%propagate-accidentals not")
    return "\n".join(lines) + "\n"


@pytest.mark.skipif(ABC2MIDI is None, reason="abc2midi is not installed")
def test_edited_tunes_are_those_of_abc2midi(read, tmp_path, everything):
    whole = re.split(r"\n(?=X:)", TUNES.read_text(encoding="utf-8"))[1:]
    plain = [tune for tune in whole if tune.count("V:") + tune.count("[K:") == 0]
    wrong = []
    for seed in range(10 if everything else 1):
        chance = random.Random(seed)
        for tune in plain:
            wrong += differences([edited(tune, chance)], read, tmp_path)
    assert len(plain) > 30
    assert not wrong


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
        ("C^f_b", [66.0, 70.0, 72.0]),
        ("exp ^c", [65.0, 71.0, 73.0]),
        ("F clef=bass middle=b", [65.0, 70.0, 72.0]),  # which are no accidentals
    ):
        notes = read(f"X:1\nL:1/4\nK:{key}\nFBc|").parts[0].notes
        assert [note.pitch for note in notes] == pitches, key


def test_keys_are_read_or_told(read):
    wrong = []
    for key, do, told in (
        ("Bflat", "Bb", ""), ("B flat major", "Bb", ""), ("B♭", "Bb", ""), ("F♯m", "A", ""),
        ("gm", "Bb", ""), ("bbm", "Db", ""), ("Bblyd", "F", ""), ("Eb Dor", "Db", ""),
        ("G blues", "G", "blues"), ("Bblues", "B", "blues"), ("g", "C", "K:g"), ("H", "C", "K:H"),
        ("sol", "C", "K:sol"), ("D strange=1", "D", "strange=1"), ("C clef=odd", "C", "clef=odd"),
    ):  # fmt: skip
        written = read(f"X:1\nL:1/4\nK:{key}\nCDEF|")
        ours = written.keys[0].do, " ".join(written.not_understood)
        if ours[0] != do or told not in ours[1] or bool(told) != bool(ours[1]):
            wrong.append((key, *ours))
    assert not wrong


def test_voices_sound_where_their_fields_say(read):
    wrong = []
    for tune, pitches in (
        ("V:1 clef=treble-8\nK:C\nV:1\nc4|", [[60]]),
        ("V:1 transpose=-2\nK:C\nV:1\nc4|", [[70]]),
        ("K:C\nV:1 octave=-1\nc|\nV:2 clef=treble-8\nc|\nV:3 transpose=-2\nc|", [[60], [60], [70]]),
        ("K:C clef=treble-8\nV:1\nc|\nV:2\nc|", [[60], [60]]),
        ("V:1 clef=treble-8\nK:C octave=1\nV:1\nc|\nV:2\nc|", [[72], [84]]),
        ('V:A\nV:B name="Low" clef=bass-8\nK:C\nV:B\nc|\nV:A\nc|', [[72], [60]]),
        ("K:C\n[V:1 octave=-1]c|[V:1]c|[V:1 octave=0]c|", [[60, 60, 72]]),
        ("K:C clef=treble-8\nc4|[K:G]c4|\nK:D\nd4|", [[60, 60, 62]]),
        ("K:C\nc4|[K:clef=treble-8]c4|[K:clef=treble]c4|", [[72, 60, 72]]),
        ("K:C treble_8\nc|", [[60]]),
        ('K:C clef="treble+15"\nC|', [[84]]),
        ("V:1\nK:D\nV:2\nK:C\nf|\nV:1\nf|", [[78], [77]]),
    ):
        own = read(f"X:1\nL:1/4\n{tune}")
        found = [[note.pitch for note in part.notes] for part in own.parts]
        if found != pitches or own.unknown:
            wrong.append((tune, pitches, found, own.unknown))
    assert not wrong
    written = read("X:1\nL:1/4\nK:D transpose=-2\nd|\nV:1 loud\n")
    assert [key.do for key in written.keys] == ["C"]  # which sounds
    assert written.not_understood == ["not understood: loud in V:"]


def test_text_between_directives_is_no_music(read):
    for kind in ("text", "ps", "svg", "ml"):
        text = f"X:1\nL:1/4\nK:C\nc|\n%%begin{kind}\na bad egg\n\nX:2\n%%end{kind}\nd|\n"
        assert [note.pitch for note in read(text).parts[0].notes] == [72.0, 74.0], kind
    written = read("X:1\nL:1/4\nK:C\nc|\n%%begintext\nd|\n")  # without an end
    assert written.not_understood == ["not understood: %%begintext"]


def test_accidentals_reach_as_far_as_a_directive_says(read):
    music = "K:C\n{}^c c c' c-|c _B-B =c|"
    for directive, pitches in (
        ("", [73, 73, 85, 73, 70, 72]),
        ("%%propagate-accidentals octave", [73, 73, 84, 73, 70, 72]),
        ("%%propagate-accidentals not", [73, 72, 84, 72, 70, 72]),
        ("I:propagate-accidentals not", [73, 72, 84, 72, 70, 72]),
        ("[I:propagate-accidentals octave]", [73, 73, 84, 73, 70, 72]),
    ):
        in_head = [] if directive.startswith("[") else [f"{directive}\n{music.format('')}".lstrip()]
        for text in (*in_head, music.format(f"{directive}\n".lstrip())):
            notes = read(f"X:1\nL:1/4\n{text}").parts[0].notes
            assert [note.pitch for note in notes] == pitches, text


def test_fields_and_directives_are_played_silent_or_told(read):
    silent = "A:x\nR:reel\n%%MIDI program 40\n%%titlefont Times 12\nI:linebreak $\n%%setfont-1 x\n"
    assert not read(f"X:1\n{silent}K:C\nCD|\nw: la la\n").not_understood
    values = "M:egg\nL:egg\n%%propagate-accidentals egg\n%%MIDI ratio egg\n"
    written = read(f"X:1\n{values}K:C\nC[e.g]{{!g}}D|\n")
    assert written.unknown == dict.fromkeys(
        ["M:egg", "L:egg", "propagate-accidentals:egg", "ratio:egg", ". in []", "! in {}"], 1
    )
    told = "%%MIDI transpose 2\n%%strange\nI:odd\nm:~n3=n\nY:1\n"
    written = read(f"X:1\n{told}K:C\nCD|\ns: !p! *\n")
    assert written.unknown == dict.fromkeys(
        ["%%MIDI transpose", "%%strange", "%%odd", "macros (m:)", "Y:", "lines of symbols (s:)"], 1
    )


def test_the_documentation_lists_fields_properties_and_directives():
    page = (Path(__file__).parents[2] / "docs/scores.md").read_text(encoding="utf-8")
    for kind in (keywords.PLAYED, keywords.SILENT, keywords.LEFT_OUT):
        for table, sign in ((keywords.FIELDS, ":"), (keywords.PROPERTIES, "=")):
            names = " ".join(f"`{name}{sign}`" for name, its in table.items() if its == kind)
            assert f"| {names} |" in page or not names, kind
    shown = " ".join(page.split())
    silent = [name for name, kind in keywords.DIRECTIVES.items() if kind == keywords.SILENT]
    of_midi = [name for name in silent if name.startswith("midi ")]
    assert f"```text {' '.join(name for name in silent if name not in of_midi)} ```" in shown
    assert f"```text {' '.join(name.removeprefix('midi ') for name in of_midi)} ```" in shown


def test_hornpipes_and_broken_rhythm_are_played_as_long_as_they_say(read):
    half, third = Fraction(1, 2), Fraction(1, 3)
    for head, music, begins in (
        ("R:hornpipe\nM:4/4", "CD EF|", [0, 2 * third, 1, 5 * third]),
        ("R:Hornpipes\nM:2/4\nL:1/16", "CD EF|", [0, third, 0.5, 5 * third / 2]),
        ("R:hornpipe\nM:6/8", "CD EF|", [0, 0.5, 1, 1.5]),
        ("R:reel\nM:4/4", "CD E>F|", [0, 0.5, 1, 1.75]),
        ("R:hornpipe\nM:C", "D|C>DE3 F|", [0, half, half + 2 * third, 3 * half, 3]),
        ("%%MIDI ratio 5 1", "C>D E<F|", [0, 5 * third / 2, 1, 1 + third / 2]),
        ("R:hornpipe\n%%MIDI ratio 3 1", "CD|", [0, 0.75]),
    ):
        notes = read(f"X:1\nL:1/8\n{head}\nK:C\n{music}").parts[0].notes
        assert [note.beat for note in notes][: len(begins)] == begins, (head, music)
    written = read("X:1\nR:hornpipe\nK:C\nC|")
    assert written.remarks == ("a hornpipe (R:): pairs of even notes are played two to one",)


def test_a_number_after_a_repeat_sign_is_no_ending(read):
    assert notes_of(read("X:1\nK:C\n|:2C D:|\n")) == notes_of(read("X:1\nK:C\n|:C D:|\n"))


def test_a_repeat_without_a_beginning_goes_back_to_a_double_bar(read):
    for sign in ("||", "|]", "[|"):
        notes = read(f"X:1\nL:1/1\nK:C\nC|D{sign}E|F:|G|").parts[0].notes
        assert [note.pitch for note in notes] == [60, 62, 64, 65, 64, 65, 67], sign


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
