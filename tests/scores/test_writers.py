"""Scores written as MusicXML and as jianpu are read again as the same scores."""

import math
from fractions import Fraction
from pathlib import Path

from hypothesis import given, settings
from hypothesis import strategies as st

from yehu_server.params.articulations import ARTICULATIONS
from yehu_server.scores.jianpu.reader import parse_jianpu
from yehu_server.scores.jianpu.writer import jianpu_of
from yehu_server.scores.musicxml.reader import parse, written_of
from yehu_server.scores.musicxml.writer import musicxml_of
from yehu_server.scores.reading import read_written
from yehu_server.scores.score import COMMON_TIME, KeySignature, Metre
from yehu_server.scores.written.layout import tuplet_of
from yehu_server.scores.written.notated import (
    DYNAMICS,
    MARKS,
    Grace,
    Mark,
    Note,
    Part,
    Sign,
    Span,
    Tempo,
    Written,
)
from yehu_server.scores.written.words import (
    WRITTEN_CHANGES,
    WRITTEN_SIGNS,
    meaning_of,
    words_of_sign,
)

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
LENGTHS = [Fraction(n, 16) for n in (1, 2, 3, 4, 6, 8, 10, 12, 14, 16, 24, 28, 32, 40, 48, 64, 92)]
GROUPS = [
    *((length,) for length in LENGTHS),
    (Fraction(1, 3),) * 3, (Fraction(2, 3), Fraction(1, 3)), (Fraction(1, 6),) * 6,
    (Fraction(2, 3),) * 3, (Fraction(1, 5),) * 5, (Fraction(2, 7), Fraction(5, 7)),
]  # fmt: skip
BOTH = ["staccato", "staccatissimo", "tenuto", "portato", "accent", "marcato", "up-bow",
        "down-bow", "fermata", "breath", "open-string", "soft-accent", "inner-string",
        "slide-in-up"]  # fmt: skip
XML_ONLY = ["spiccato", "stress", "slide-out-up", "slide-out-down", "arpeggio", "pizzicato"]


def as_musicxml(written: Written) -> tuple[Written, dict[str, int]]:
    data, lost = musicxml_of(written)
    return written_of(parse(data)), lost


def as_jianpu(written: Written) -> tuple[Written, dict[str, int]]:
    text, lost = jianpu_of(written)
    return parse_jianpu(text.encode()), lost


@st.composite
def parts(draw, marks, quarters):
    notes, beat = [], Fraction(0)
    for group in draw(st.lists(st.sampled_from(GROUPS), min_size=1, max_size=24)):
        if tuplet_of(group[0].denominator) != 1:  # tuplets stand on a half beat
            beat = Fraction(math.ceil(2 * beat), 2)
            if beat % quarters + sum(group) > quarters:
                beat = -(-beat // quarters) * quarters
        for length in group:
            if draw(st.integers(0, 5)):
                names = draw(st.lists(st.sampled_from(marks), max_size=2, unique=True))
                before = [Grace(67.0, Fraction(1, 4))] * draw(st.sampled_from([0, 0, 0, 1, 2]))
                pitch = float(draw(st.integers(55, 92)))
                own = tuple(map(Mark, names))
                notes.append(Note(beat, length, pitch, own, tuple(before)))
            beat += length
    if not notes:
        notes.append(Note(beat, Fraction(1), 67.0))
    spans, at = [], 0
    while at + 1 < len(notes):
        last = min(at + draw(st.integers(1, 4)), len(notes) - 1)
        name = draw(st.sampled_from(["", "slur", "crescendo", "diminuendo", "glissando"]))
        last = at + 1 if name == "glissando" else last
        if name:
            spans.append(Span(name, notes[at].beat, notes[last].beat))
        at = last + draw(st.integers(0, 1))
    dynamics = draw(st.lists(st.sampled_from(notes), max_size=3, unique_by=lambda n: n.beat))
    words = [sign for sign in WRITTEN_SIGNS if sign[0] != "staccato"]
    names = [(name, None) for name in DYNAMICS] + words
    signs = [Sign(note.beat, *draw(st.sampled_from(names))) for note in dynamics]
    hairpins = [span for span in spans if span.name in ("crescendo", "diminuendo")]
    signs = [  # a dynamic ends a hairpin of jianpu
        sign for sign in signs if not any(each.begin < sign.beat < each.end for each in hairpins)
    ]
    ordered = tuple(sorted(signs, key=lambda sign: sign.beat))
    return Part(draw(st.sampled_from(["", "Yehu"])), tuple(notes), tuple(spans), ordered)


@st.composite
def scores(draw, marks):
    quarters = draw(st.sampled_from([2.0, 3.0, 4.0, 1.5, 5.0]))
    fifths = draw(st.one_of(st.none(), st.integers(-5, 6)))
    found = tuple(draw(st.lists(parts(marks, Fraction(quarters)), min_size=1, max_size=2)))
    tempi = [Tempo(Fraction(0), float(draw(st.integers(30, 240))))]
    if draw(st.booleans()) and found[0].notes[-1].beat > 0:
        tempi.append(Tempo(found[0].notes[-1].beat, 72.0))
    keys = () if fifths is None else (KeySignature(Fraction(0), fifths),)
    return Written(
        found, tuple(tempi), (COMMON_TIME, Metre(0.0, quarters)), (), "A tune", keys=keys
    )


def contents(written: Written) -> dict[str, object]:
    """All that is held, in no order where it has none."""
    return {
        "title": written.title,
        "tempi": written.tempi,
        "keys": written.keys,
        "names": [part.name for part in written.parts],
        "notes": [part.notes for part in written.parts],
        "spans": [{*part.spans} for part in written.parts],
        "signs": [{*part.signs} for part in written.parts],
        "bars": [written.place(note.beat) for part in written.parts for note in part.notes],
    }


@given(scores([*BOTH, *XML_ONLY]))
@settings(max_examples=25, deadline=None)
def test_what_is_written_as_musicxml_is_read_as_it_was(written):
    again, lost = as_musicxml(written)
    assert contents(again) == contents(written)
    assert not lost
    assert not again.unknown
    assert not again.warnings


@given(scores(BOTH))
@settings(max_examples=25, deadline=None)
def test_what_is_written_as_jianpu_is_read_as_it_was(written):
    again, lost = as_jianpu(written)
    assert contents(again) == contents(written)
    assert not lost
    assert not again.unknown


def test_examples_are_the_same_in_both_notations(everything):
    different = []
    for path in sorted(EXAMPLES.rglob("*.jianpu"))[:: 1 if everything else 2]:
        written = read_written(path)
        for write in (as_musicxml, as_jianpu):
            again, lost = write(written)
            if "huo_wu" in path.name:
                assert lost["pitches that move within a note"] == 7
            elif contents(again) != contents(written):
                different.append((path.name, write))
    assert not different


def test_each_mark_is_written_or_counted_as_lost():
    """Of MusicXML all marks are read again; of jianpu those that are not are named."""
    for write in (as_musicxml, as_jianpu):
        missing = []
        for name in MARKS:
            value = 2.0 if name in ("trill", "turn", "inverted-mordent") else None
            value = {"articulation": 3.0, "finger": 2.0, "mordent": 1.0, "inverted-turn": 2.0}.get(
                name, value
            )
            note = Note(Fraction(0), Fraction(4), 67.0, (Mark(name, value),))
            again, lost = write(Written((Part("", (note,)),)))
            names = [mark.name for mark in again.parts[0].notes[0].marks]
            if names != [name] and not lost:
                missing.append(name)
            if write is as_musicxml:
                assert names == [name]
                assert again.parts[0].notes[0].marks[0].value == value
        assert not missing


def test_what_a_notation_has_no_sign_for_is_counted_and_the_rest_written():
    note = Note(Fraction(0), Fraction(4), 67.25, (), contour=((0.0, 0.0), (1.0, 1.0)))
    other = Note(Fraction(4), Fraction(1, 3), 69.0)
    last = Note(Fraction(13, 3), Fraction(5, 8), 71.0)
    slurs = (
        Span("slur", Fraction(0), Fraction(13, 3)),
        Span("portamento", Fraction(0), Fraction(4)),
    )
    whole = Written((Part("", (note, other, last), slurs),))
    again, lost = as_jianpu(whole)
    assert lost == {
        "pitches between semitones": 1, "pitches that move within a note": 1, "portamento": 1,
    }  # fmt: skip
    assert [each.pitch for each in again.parts[0].notes] == [67.0, 69.0, 71.0]
    assert [span.name for span in again.parts[0].spans] == ["slur"]
    again, lost = as_musicxml(whole)
    assert lost == {"pitches that move within a note": 1}
    assert [each.pitch for each in again.parts[0].notes] == [67.25, 69.0, 71.0]
    fine = other._replace(beat=Fraction(4) + Fraction(1, 99_991))
    again, lost = as_musicxml(Written((Part("", (note, fine)),)))
    assert lost["beats finer than 1/5040 of a quarter"] == 2
    assert again.parts[0].notes[1].beat == 4


def test_words_of_signs_are_read_as_what_they_say():
    said = [*WRITTEN_SIGNS.items()]
    for kind in ("articulation", "gesture"):
        signs = [(kind, float(number)) for number in range(len(ARTICULATIONS))]
        said += [(sign, text) for sign in signs if (text := words_of_sign(*sign)) is not None]
    for sign, text in said:
        assert (meaning_of(text).name, meaning_of(text).value) == sign
    assert [meaning_of(text).name for text in WRITTEN_CHANGES.values()] == [*WRITTEN_CHANGES]
