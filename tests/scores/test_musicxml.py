"""What MusicXML says, mark by mark; and files that are damaged or made to harm."""

import io
import zipfile
from fractions import Fraction
from itertools import pairwise
from pathlib import Path

import pytest
from musicxml_text import (
    HEAD,
    articulation,
    attributes,
    barline,
    dynamics,
    grace,
    note,
    ornament,
    score,
    slur,
    technical,
    tempo,
    wedge,
    words,
)

from yehu_server.errors import ScoreError
from yehu_server.params.articulations import NUMBER
from yehu_server.scores.musicxml import elements, reader
from yehu_server.scores.musicxml.reader import DEEPEST, MAX_XML_BYTES, read_musicxml
from yehu_server.scores.written.notated import MARKS, SPANS
from yehu_server.scores.written.words import meaning_of

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "marks.musicxml"
FOUR = "".join(note(name, 1) for name in ("G4", "A4", "B4", "C5"))
CONTAINER = '<container><rootfiles><rootfile full-path="{}"/></rootfiles></container>'


@pytest.fixture
def read(tmp_path):
    """Read a text, or bytes, as a file."""

    def run(text, name="tune.musicxml"):
        path = tmp_path / name
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return read_musicxml(path)

    return run


def marks_of(written, number=0) -> list[tuple[str, float | None]]:
    return [(mark.name, mark.value) for mark in written.parts[0].notes[number].marks]


def spans_of(written) -> list[tuple[str, float, float]]:
    return [(span.name, float(span.begin), float(span.end)) for span in written.parts[0].spans]


def signs_of(written) -> list[tuple[str, float]]:
    return [(sign.name, float(sign.beat)) for sign in written.parts[0].signs]


# -- marks --------------------------------------------------------------------------------------


def test_marks_are_understood(subtests, read):
    for notation, name, value in [
        (articulation("staccato"), "staccato", None),
        (articulation("strong-accent"), "marcato", None),
        (articulation("detached-legato"), "portato", None),
        (articulation("scoop"), "slide-in-up", None),
        (articulation("plop"), "slide-in-down", None),
        (articulation("doit"), "slide-out-up", None),
        (articulation("falloff"), "slide-out-down", None),
        (articulation("breath-mark"), "breath", None),
        (technical("up-bow"), "up-bow", None),
        (technical("down-bow"), "down-bow", None),
        (technical("open-string"), "open-string", None),
        (technical("fingering", "3"), "finger", 3.0),
        (technical("string", "1"), "outer-string", None),
        (technical("string", "2"), "inner-string", None),
        (technical("snap-pizzicato"), "snap-pizzicato", None),
        (technical("harmonic"), "harmonic", None),
        (technical("other-technical", "Ricochet"), "articulation", float(NUMBER["ricochet"])),
        ("<fermata/>", "fermata", None),
        (ornament("trill-mark"), "trill", 2.0),
        (ornament("mordent"), "mordent", 1.0),
        (ornament("inverted-mordent"), "inverted-mordent", 2.0),
        ("<ornaments><tremolo>3</tremolo></ornaments>", "tremolo", 3.0),
        ('<ornaments><tremolo type="unmeasured">0</tremolo></ornaments>', "tremolo", None),
    ]:
        with subtests.test(notation=notation, name=name, value=value):
            written = read(score(note("C5", 4, notation)))
            assert marks_of(written) == [(name, value)]
            assert not written.unknown


def test_a_trill_goes_to_the_next_note_of_the_key_as_written_or_to_its_own_accidental(read):
    trill = ornament("trill-mark")
    own = "<ornaments><trill-mark/><accidental-mark>{}</accidental-mark></ornaments>"
    clarinet = "<transpose><chromatic>-2</chromatic></transpose>"
    for text, width in [
        (note("E4", 4, trill), 1.0),
        (note("F4", 4, trill), 2.0),
        (attributes(fifths=1) + note("E4", 4, trill), 2.0),
        (attributes(fifths=-1) + note("A4", 4, trill), 1.0),
        (attributes(fifths=-3) + note("D4", 4, trill), 1.0),
        (attributes(fifths=7) + note("A#4", 4, trill), 2.0),  # B# is a semitone above A##
        (attributes(more=clarinet) + note("E5", 4, trill), 1.0),
        (note("G4", 4, own.format("flat")), 1.0),
        (note("Ab4", 4, own.format("natural")), 3.0),
        (note("F4", 4, own.format("double-sharp")), 4.0),  # as far as a finger of a trill goes
        (note("Fb4", 4, own.format("double-sharp")), 2.0),
        (note("E#4", 4, trill), 2.0),  # F is the same
    ]:
        assert marks_of(read(score(text))) == [("trill", width)], text


def test_what_is_not_understood_is_counted_and_named(read):
    swoosh = "<articulations><other-articulation>swoosh</other-articulation></articulations>"
    text = score(
        note("G4", 1, ornament("schleifer"))
        + note("A4", 1, ornament("schleifer"))
        + note("B4", 1, technical("bend", "<bend-alter>1</bend-alter>"))
        + note("C5", 1, swoosh)
        + words("with a smile")
    )
    names = {"schleifer": 2, "bend": 1, "other-articulation swoosh": 1, 'words "with a smile"': 1}
    assert read(text).unknown == names


def test_each_element_is_played_silent_or_told_and_the_documentation_says_which(read):
    kinds = (elements.PLAYED, elements.TOLD, elements.SILENT)
    assert len(frozenset().union(*kinds)) == sum(map(len, kinds)) == 442  # of the schema
    page = " ".join(EXAMPLE.parents[1].joinpath("docs/scores.md").read_text("utf-8").split())
    for kind in kinds:
        assert f"```text {' '.join(sorted(kind))} ```" in page
    strange = "<egg>spam</egg>"  # wherever it is
    dynamics = f"<dynamics>{strange}</dynamics>"
    text = score(note("G4", 1, f"<ornaments><turn>{strange}</turn></ornaments>{dynamics}"))
    text = text.replace("</part-list>", f"{strange}</part-list>")
    text = text.replace("</measure>", f"<harmony><kind>{strange}</kind></harmony></measure>")
    assert read(text).unknown == {"egg": 4}
    style = '<attributes><measure-style><slash type="{}"/></measure-style></attributes>'
    swing = "<sound><swing><first>0</first><second>1</second></swing></sound>"
    pedal = '<direction><direction-type><pedal type="start"/></direction-type></direction>'
    more = "<sound><swing><straight/></swing></sound><print/><strange><pitch/></strange>"
    bars = (swing + FOUR, style.format("start") + pedal + FOUR, style.format("stop") + FOUR + more)
    assert read(score(*bars)).unknown == {
        "swing (bar 1)": 1, "slash (bar 2)": 1, "pedal": 1, "strange": 1,
    }  # fmt: skip


def test_a_sign_repeats_the_bars_before(read):
    sign = '<measure-style{}><measure-repeat type="{}">{}</measure-repeat></measure-style>'
    sign = f"<attributes>{sign}</attributes>"
    one, stop = sign.format("", "start", 1), sign.format("", "stop", "")
    other = "".join(note(name, 1) for name in ("C5", "C5", "C5", "D5"))
    rest, last = note("r", 4), note("G4", 4)
    for bars, played in [
        ([FOUR, one + rest, rest, stop + last], [FOUR, FOUR, FOUR, last]),
        ([FOUR, other, sign.format("", "start", 2) + rest, rest], [FOUR, other, FOUR, other]),
        ([FOUR, one + other, stop + rest], [FOUR, other, rest]),  # its notes are there
        ([FOUR, sign.format(' number="1"', "start", 1) + rest], [FOUR, FOUR]),
        ([attributes() + one + rest, FOUR], [rest, FOUR]),
    ]:
        found, right = read(score(*bars)).parts[0].notes, read(score(*played)).parts[0].notes
        assert found == right, bars


def test_a_sign_repeats_the_beat_before(read):
    sign = '<measure-style{}><beat-repeat type="{}">{}</beat-repeat></measure-style>'
    sign = f"<attributes>{sign}</attributes>"
    one, stop = sign.format("", "start", ""), sign.format("", "stop", "")
    beat, rest, last = note("F4", 0.5) + note("G4", 0.5), note("r", 1), note("G4", 4)
    start = attributes() + beat
    half = sign.format("", "start", "<slash-type>half</slash-type>")
    for bars, played in [
        ([start + one + rest * 3, stop + last], [beat * 4, last]),
        ([start + one + rest * 2 + stop + note("A4", 1)], [beat * 3 + note("A4", 1)]),
        ([beat * 4, one + rest * 4, stop + rest * 4], [beat * 4, beat * 4, note("r", 4)]),
        ([start + one + beat * 3], [beat * 4]),  # its notes are there
        ([start + note("A4", 1) + half + note("r", 2)], [(beat + note("A4", 1)) * 2]),
        ([attributes() + one + note("r", 4), last], [note("r", 4), last]),
    ]:
        found, right = read(score(*bars)), read(score(*played))
        assert found.parts[0].notes == right.parts[0].notes, bars
        assert not found.unknown


def test_swing_delays_what_begins_on_off_beats(read):
    def swing(*values, unit=""):
        names = zip(
            ("first", "second", "swing-type"), (*values, *filter(None, [unit])), strict=False
        )
        said = "".join(f"<{name}>{value}</{name}>" for name, value in names)
        return f"<sound><swing>{said or '<straight/>'}</swing></sound>"

    eighths = note("F4", 0.5) + note("G4", 0.5)
    third = Fraction(1, 3)
    for bars, begins in [
        ([swing(2, 1) + eighths + note("A4", 3)], [0, 2 * third, 1]),
        ([swing(3, 2) + note("F4", 1.5) + note("G4", 2.5)], [0, Fraction(8, 5)]),
        ([swing(2, 1) + note("r", 0.5) + note("F4", 1) + note("G4", 0.5)], [2 * third, 5 * third]),
        ([swing(2, 1) + note("F4", 0.5) + note("G4", 0.25) * 2], [0, 0.5, 0.75]),
        ([swing(2, 1) + note("F4", 0.25) * 2 + note("G4", 0.5)], [0, 0.25, 0.5]),
        ([swing(2, 1, unit="16th") + note("F4", 0.25) * 2 + eighths], [0, third / 2 * 2, 0.5, 1]),
        ([swing(2, 1) + eighths + swing() + eighths, eighths], [0, 2 * third, 1, 1.5, 2, 2.5]),
        ([swing(2, 1) + note("F4", 0.5), note("G4", 4)], [third / 2, 0.5]),  # an upbeat
        ([swing(2, 1) + note("F4", 0.5) + grace("C5") + note("G4", 0.5)], [0, 2 * third]),
        ([swing(1, 3) + eighths], [0, 0.25]),
    ]:
        written = read(score(*bars))
        notes = written.parts[0].notes
        assert [n.beat for n in notes] == begins, bars
        assert all(a.end <= b.beat for a, b in pairwise(notes))
        assert not written.unknown


def test_a_tie_may_go_on_in_another_voice(read):
    start, stop = ('<tie type="start"/>', '<tie type="stop"/>')
    first = note("G4", 2) + note("A4", 2, more=start)
    second = note("A4", 1, more=stop, voice=2) + note("B4", 3, voice=2)
    one, other = read(score(first, second)).parts
    assert [(n.pitch, n.length) for n in one.notes] == [(67.0, 2), (69.0, 3)]
    assert [(n.pitch, n.length) for n in other.notes] == [(71.0, 3)]
    again = note("A4", 1, more=stop) + note("A4", 3, more=stop, voice=2)  # tied by its own voice
    assert [n.length for n in read(score(first, again)).parts[0].notes] == [2, 3]


def test_what_is_tied_to_a_lower_note_of_a_chord_is_not_struck(read):
    start, stop = ('<tie type="start"/>', '<tie type="stop"/>')
    for chord in (
        note("A4", 2, more=start) + note("+C5", 2),
        note("C5", 2) + note("+A4", 2, more=start),
    ):
        for last, rest in (
            (note("A4", 2, more=stop), []),
            (note("A4", 2, more=stop) + note("+F4", 2), [65.0]),
        ):
            part = read(score(chord + last, note("B4", 4))).parts[0]
            assert [n.pitch for n in part.notes] == [72.0, *rest, 71.0]
    whole = start + stop
    played = read(
        score(chord + note("A4", 2, more=whole), note("A4", 2, more=stop) + note("A4", 2))
    )
    assert [(n.pitch, n.beat) for n in played.parts[0].notes] == [(72.0, 0), (69.0, 6)]


def test_a_wavy_line_alone_is_a_vibrato_of_all_its_notes(read):
    wavy = '<ornaments><wavy-line type="{}"/></ornaments>'
    names = note("G4", 1, wavy.format("start")) + note("A4", 1) + note("B4", 1, wavy.format("stop"))
    notes = read(score(names + note("C5", 1))).parts[0].notes
    assert [n.marked("vibrato") is not None for n in notes] == [True, True, True, False]


def test_notes_of_one_pass_sound_in_that_one(read):
    def only(name, turn):
        return note(name, 4).replace("<note>", f'<note time-only="{turn}">')

    back = "<backup><duration>48</duration></backup>"
    text = score(only("G4", "1") + back + only("A4", "2, 3") + barline(repeat="backward"), FOUR)
    assert [n.pitch for n in read(text).parts[0].notes][:3] == [67.0, 69.0, 67.0]
    assert [n.beat for n in read(text).parts[0].notes][:3] == [0, 4, 8]


def test_a_tremolo_over_two_notes_is_a_trill_of_both_on_one_bow(read):
    start, stop = (
        f'<ornaments><tremolo type="{kind}">3</tremolo></ornaments>' for kind in ("start", "stop")
    )
    written = read(score(note("G4", 2, start) + note("B4", 2, stop)))
    assert [marks_of(written, n) for n in (0, 1)] == [[("trill", 4.0)], [("trill", -4.0)]]
    assert spans_of(written) == [("slur", 0.0, 2.0)]


def test_grace_notes_belong_to_the_note_after_them_or_before_them(read):
    written = read(
        score(
            grace("A4") + note("G4", 2) + grace("C5", ' steal-time-previous="50"') + note("D5", 2),
            note("E5", 4) + grace("D5") + grace("E5"),
        )
    )
    notes = written.parts[0].notes
    assert [[small.pitch for small in each.before] for each in notes] == [[69.0], [], []]
    assert [[small.pitch for small in each.after] for each in notes] == [[72.0], [], [74.0, 76.0]]


# -- spans and directions -----------------------------------------------------------------------


def test_slurs_glissandos_and_hairpins_last_from_note_to_note(subtests, read):
    first, second = note("G4", 2, slur("start")), note("A4", 2, slur("stop"))
    glides = [f'<glissando type="{kind}" number="2"/>' for kind in ("start", "stop")]
    within = wedge("crescendo") + note("G4", 1, slur("start")) + note("A4", 1)
    begun = note("G4", 1, slur("start")) + note("A4", 1, slur("start"), slur("stop"))
    for bars, spans in [
        (
            [
                within
                + note("B4", 1, slur("stop"), glides[0])
                + wedge("stop")
                + note("E5", 1, glides[1])
            ],
            [("slur", 0.0, 2.0), ("crescendo", 0.0, 3.0), ("glissando", 2.0, 3.0)],
        ),
        ([begun + note("B4", 1, slur("stop"))], [("slur", 0.0, 1.0), ("slur", 1.0, 2.0)]),
        ([first + second + barline(repeat="backward")], [("slur", 0.0, 2.0), ("slur", 4.0, 6.0)]),
        # In words up to the next dynamic.
        ([dynamics("p") + words("cresc.") + FOUR, dynamics("f") + FOUR], [("crescendo", 0.0, 4.0)]),
    ]:
        with subtests.test(spans=spans):
            assert spans_of(read(score(*bars))) == spans


def test_rit_lasts_to_a_tempo_which_brings_the_tempo_back(read):
    written = read(score(tempo(90) + FOUR, words("rit.") + FOUR, words("a tempo") + FOUR))
    assert spans_of(written) == [("ritardando", 4.0, 8.0)]
    tempi = [(each.beat, each.quarters_per_minute) for each in written.tempi]
    assert tempi == [(0, 90.0), (8, 90.0)]


def test_a_metronome_mark_counts_in_its_unit_and_figures_go_over_words(read):
    mark = (
        "<direction><direction-type><metronome><beat-unit>eighth</beat-unit><beat-unit-dot/>"
        "<per-minute>80</per-minute></metronome></direction-type></direction>"
    )
    figures = [words("Allegretto"), '<sound tempo="189"/>']
    for signs, expected in (([mark], 60.0), (figures, 189.0), (figures[::-1], 189.0)):
        tempi = read(score("".join(signs) + FOUR)).tempi
        assert [(each.beat, each.quarters_per_minute) for each in tempi] == [(0, expected)]


def test_a_direction_stands_where_its_offset_says_and_sounds_there_if_that_says_so(read):
    for how, beat in (("", 0.0), (' sound="yes"', 1.0)):
        direction = (
            "<direction><direction-type><dynamics><f/></dynamics></direction-type>"
            f'<offset{how}>12</offset><sound tempo="70"/></direction>'
        )
        written = read(score(direction + FOUR))
        assert signs_of(written) == [("f", 1.0)]
        assert [float(each.beat) for each in written.tempi] == [beat]


def test_words_have_a_meaning():
    meanings = {
        "pizz.": ("sign", "pizz"), "Arco": ("sign", "arco"), "拨弦": ("sign", "pizz"),
        "sul pont.": ("sign", "sul-ponticello"), "sul tasto": ("sign", "sul-tasto"),
        "flautando": ("sign", "flautando"), "ord.": ("sign", "ordinary"),
        "外弦": ("sign", "outer-string"), "sempre pp": ("sign", "pp"),
        "poco a poco cresc.": ("hairpin", "crescendo"), "dim.": ("hairpin", "diminuendo"),
        "poco rit.": ("change", "ritardando"), "a tempo": ("back", ""),
        "Allegro ma non troppo": ("tempo", ""), "D.C. al Fine": ("jump", "dacapo"),
        "D.S. al Coda": ("jump", "dalsegno"), "To Coda": ("jump", "tocoda"),
        "Fine": ("jump", "fine"),
    }  # fmt: skip
    found = {text: meaning_of(text) for text in meanings}
    assert {text: (each.kind, each.name) for text, each in found.items()} == meanings
    for text in ("dolce", "", "con sord.", "bow to the audience", "primo", "x" * 300):
        assert meaning_of(text) is None


# -- what a score is made of --------------------------------------------------------------------


def test_title_bars_and_metre_are_those_of_the_score(read):
    bars = (attributes(3, 4) + note("C5", 1), note("D5", 3), note("E5", 3))
    written = read(score(*bars, title="Upbeat"))
    assert written.title == "Upbeat"
    places = [written.place(each.beat) for each in written.parts[0].notes]
    assert places == [("1", 0), ("2", 0), ("3", 0)]
    assert (written.metres[-1].beat, written.metres[-1].quarters) == (1.0, 3.0)


def test_an_interrupted_ending_does_not_play_for_ever(read):
    bar = barline(location="left", ending="1 start") + FOUR + barline(repeat="backward")
    assert len(read(score(bar)).parts[0].notes) == 4


def test_lower_notes_of_chords_are_counted_and_voices_are_parts_of_their_own(read):
    written = read(score(note("F4", 4) + note("+C5", 4)))
    assert [each.pitch for each in written.parts[0].notes] == [72.0]
    assert "chords" in written.warnings[0]
    back = "<backup><duration>48</duration></backup>"
    chord = note("+A4", 4).replace("<voice>1</voice>", "")  # without a voice it is its chord's
    written = read(score(note("C5", 4) + back + note("F4", 4, voice=2) + chord))
    assert [part.name for part in written.parts] == ["P1", "P1, voice 2"]
    assert [[each.pitch for each in part.notes] for part in written.parts] == [[72.0], [69.0]]


def test_bars_in_parts_and_parts_in_bars_are_the_same_score(read):
    partwise = score(FOUR, note("G4", 4))
    bars = [
        f'<measure number="{n}"><part id="P1">{content}</part></measure>'
        for n, content in ((1, attributes() + FOUR), (2, note("G4", 4)))
    ]
    timewise = f"{HEAD}<score-timewise>{''.join(bars)}</score-timewise>"
    assert read(timewise).parts[0].notes == read(partwise).parts[0].notes


def test_any_usual_encoding_is_read_whatever_it_calls_itself(read):
    names = {"utf-8": "utf-8", "utf-16": "utf-16", "iso-8859-1": "iso-8859-1", "UTF-16": "utf-8"}
    for declared, encoding in names.items():
        data = f'<?xml version="1.0" encoding="{declared}"?>{score(FOUR, title="Fauré", before="")}'
        assert read(data.encode(encoding)).title == "Fauré", declared


def test_of_hidden_notes_those_without_a_place_on_the_page_are_silent(read):
    """Programs realize ornaments in such notes, in a voice of their own; MuseScore skips them."""
    hidden = note("D5", 1).replace("<note>", '<note print-object="no">')
    silent = note("E5", 1).replace("<note>", '<note print-object="no" print-spacing="no">')
    written = read(score(note("C5", 1) + hidden + silent + note("F5", 1)))
    assert [(each.beat, each.pitch) for each in written.parts[0].notes] == [
        (0, 72.0), (1, 74.0), (3, 77.0)
    ]  # fmt: skip
    assert written.warnings == ("hidden notes without a place on the page are not played",)


def test_a_cue_note_that_heads_a_chord_shifts_nothing_and_a_grace_note_may_be_on_another_staff(
    read,
):
    cue = note("G4", 1).replace("<note>", "<note><cue/>")
    chord = note("+B4", 1).replace("<chord/>", "<cue/><chord/>")
    small = grace("G4").replace("</note>", "<staff>2</staff></note>")
    [part] = read(score(cue + chord + small + note("C5", 3))).parts
    assert [(each.beat, each.pitch) for each in part.notes] == [(1, 72.0)]
    assert [each.pitch for each in part.notes[0].before] == [67.0]


def test_a_rest_that_one_part_has_too_much_makes_no_bar_longer(read):
    def begins(*bars):
        return [float(bar.beat) for bar in read(score(*bars)).bars]

    other = score(FOUR, P2=FOUR + note("r", 2)).replace("</measure></part>", "</measure>{}</part>")
    more = f'<measure number="2">{FOUR}</measure>'
    assert [float(bar.beat) for bar in read(other.format(more, more)).bars] == [0.0, 4.0]
    assert begins(FOUR + note("r", 2), FOUR) == [0.0, 6.0]  # of a part alone it may be meant
    longer = score(FOUR, P2=FOUR + note("G4", 2)).replace(
        "</measure></part>", f"</measure>{more}</part>"
    )
    assert [float(bar.beat) for bar in read(longer).bars] == [0.0, 6.0]


def test_endings_without_numbers_are_read_and_bars_that_nobody_plays_are_listed(read):
    first = barline(location="left", ending="0 start").replace('number="0"', 'number=""')
    stop = barline(repeat="backward", ending="0 stop").replace('number="0"', 'number=""')
    for begin in (first, ""):
        bars = (
            note("G4", 4),
            begin + note("A4", 4) + stop,
            barline(location="left", ending="2 start") + note("B4", 4) + barline(ending="2 stop"),
        )
        pitches = [each.pitch for each in read(score(*bars)).parts[0].notes]
        assert pitches == [67.0, 69.0, 67.0, 71.0]
    stop = barline(repeat="backward", ending="2 stop")  # as one program writes a first ending
    bars = (note("G4", 4), note("A4", 4) + stop, bars[2])
    pitches = [each.pitch for each in read(score(*bars)).parts[0].notes]
    assert pitches == [67.0, 69.0, 67.0, 71.0]
    jump = '<direction><sound {}="x"/></direction>'
    signs = ("segno", "tocoda", "dalsegno", "", "coda")
    bars = [(jump.format(sign) if sign else "") + FOUR for sign in signs]
    assert "1 bar is not played, which repeats or jumps pass over: 4" in read(score(*bars)).warnings


# -- archives -----------------------------------------------------------------------------------


def packed(files: dict[str, str | bytes], compression=zipfile.ZIP_DEFLATED) -> bytes:
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w", compression) as archive:
        for name, text in files.items():
            archive.writestr(name, text)
    return data.getvalue()


def test_the_container_of_an_archive_names_its_score_without_one_it_is_the_only_one(read):
    for name in ("tune.musicxml", "folder/tune.xml", "../../../etc/tune.xml"):
        container = {"META-INF/container.xml": CONTAINER.format(name), "a.xml": "<no/>"}
        data = packed({**container, name: score(FOUR)})
        assert len(read(data, "tune.mxl").parts[0].notes) == 4
    assert len(read(packed({"x.xml": score(FOUR)}), "tune.mxl").parts[0].notes) == 4
    for more in ({"__MACOSX/._s.xml": "\0\5\x16\7"}, {"META-INF/container.xml": "<container><"}):
        assert len(read(packed({**more, "s.xml": score(FOUR)}), "tune.mxl").parts[0].notes) == 4


def test_an_archive_that_is_damaged_or_made_to_harm_is_refused(subtests, read):
    whole = packed({"x.xml": score(FOUR)})
    for data, reason in [
        (packed({"readme.txt": "no"}), "without a score"),
        (packed({"bomb.xml": b" " * (MAX_XML_BYTES + 1)}), "larger than"),
        (packed({"META-INF/container.xml": b" " * (1 << 20), "x.xml": "<x/>"}), "larger than"),
        (packed({f"{n}.txt": "" for n in range(1001)}), "more than 1000 files"),
        *((whole[:cut], "archive") for cut in (10, len(whole) // 2, len(whole) - 5)),
        (packed({"x.xml": score(FOUR)}, zipfile.ZIP_BZIP2), "archive"),
    ]:
        with subtests.test(len(data), reason=reason), pytest.raises(ScoreError, match=reason):
            read(data, "tune.mxl")


# -- files made to harm -------------------------------------------------------------------------

TENFOLD = "".join(f'<!ENTITY l{n} "{f"&l{n - 1};" * 10}">' for n in range(1, 10))
LAUGHS = f'<!DOCTYPE x [<!ENTITY l0 "ha">{TENFOLD}'


def test_a_file_that_is_no_score_is_refused_in_one_line(subtests, read, monkeypatch):
    monkeypatch.setattr(reader, "MAX_ELEMENTS", 1000)
    for text, reason in [
        ("", "is empty"),
        ("hello", "not XML"),
        ("<score-partwise>", "not XML"),
        ("<html/>", "not a MusicXML"),
        (f"{LAUGHS}]><score-partwise>&l9;</score-partwise>", "entities"),
        ('<!DOCTYPE x [<!ENTITY a SYSTEM "file:///etc/passwd">]><x>&a;</x>', "entities"),
        ("<a>" * (DEEPEST + 1), "deeper"),
        ("<score-partwise>" + "<a/>" * 1000 + "</score-partwise>", "elements"),
        (score(attributes() + note("G4", 1e6)), "longer"),
        ('<?xml version="1.0" encoding="ebcdic-moon"?><x/>', "ebcdic-moon"),
    ]:
        with subtests.test(text[:40], reason=reason):
            with pytest.raises(ScoreError, match=reason) as refusal:
                read(text)
            assert "tune.musicxml: " in str(refusal.value)
            assert str(refusal.value).isprintable()


def test_a_missing_file_is_named_and_a_document_type_not_fetched(read, tmp_path):
    with pytest.raises(ScoreError, match=r"none\.mxl: no such file"):
        read_musicxml(tmp_path / "none.mxl")
    text = score(FOUR, before='<!DOCTYPE score-partwise SYSTEM "http://127.0.0.1:1/x.dtd">')
    assert read(text).parts[0].notes


def test_repeats_cannot_make_a_small_file_endless(read):
    times = '<barline><repeat direction="backward" times="{}"/></barline>'
    for bars in (
        [FOUR + times.format(999_999_999)] * 300,
        [barline(location="left", repeat="forward") + FOUR * 50 + times.format(100)] * 3,
        [note("r", 4) + times.format(100)] * 300,
    ):
        with pytest.raises(ScoreError, match="with its repeats"):
            read(score(*bars))


def test_numbers_beyond_reason_are_left_out(read):
    for value in ("nan", "inf", "-5", "1e300", "", "abc", "9" * 5000):
        text = score(FOUR).replace("<duration>12</duration>", f"<duration>{value}</duration>", 1)
        text = text.replace("<divisions>12</divisions>", f"<divisions>{value}</divisions>")
        assert all(each.length > 0 for part in read(text).parts for each in part.notes), value


def test_notes_that_overlap_in_a_voice_are_cut(read):
    back = "<backup><duration>24</duration></backup>"
    notes = read(score(note("G4", 4) + back + note("A4", 2))).parts[0].notes
    assert [(each.beat, each.length, each.pitch) for each in notes] == [(0, 2, 67.0), (2, 2, 69.0)]


def test_the_example_has_every_mark_that_musicxml_can_write(read):
    written = read(EXAMPLE.read_bytes())
    marks = {mark.name for each in written.parts[0].notes for mark in each.marks}
    # Words say what is plucked, shaken or else articulated; an arpeggio is nothing for a fiddle.
    assert set(MARKS) - marks == {"pizzicato", "arpeggio", "vibrato", "articulation"}
    assert {span.name for span in written.parts[0].spans} == set(SPANS) - {"accelerando"}
    assert not written.unknown
    assert not written.warnings
