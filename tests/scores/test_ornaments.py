"""Ornaments touch the next notes of the key that holds at their place, whichever notation it is."""

from fractions import Fraction

import pytest
from musicxml_text import attributes, note, score

from yehu_server.scores.abc.reader import read_abc
from yehu_server.scores.jianpu.reader import parse_jianpu
from yehu_server.scores.jianpu.writer import jianpu_of
from yehu_server.scores.musicxml.reader import parse, written_of
from yehu_server.scores.musicxml.writer import musicxml_of
from yehu_server.scores.written.notated import Written
from yehu_server.scores.written.performed import performed

ABC = "X:1\nM:4/4\nL:1/4\nQ:1/4=60\nK:{}\n{}|\n"
WAVY = '<ornaments>{}<wavy-line type="{}"/></ornaments>'


def ornament(name, accidental="", placement=""):
    place = f' placement="{placement}"' if placement else ""
    more = f"<accidental-mark{place}>{accidental}</accidental-mark>" if accidental else ""
    return f"<ornaments><{name}/>{more}</ornaments>"


TRILL, TURN, MORDENT = map(ornament, ("trill-mark", "turn", "mordent"))


def keys_of(written: Written) -> list[list[int]]:
    """The keys that each note touches, its own first."""
    found: list[tuple[float, list[int]]] = []
    for each in performed(written).notes:
        if not found or each.start_s >= found[-1][0]:
            found.append((each.end_s, []))
        if each.key not in found[-1][1]:
            found[-1][1].append(each.key)
    return [keys for _, keys in found]


def of_abc(key: str, text: str, folder) -> Written:
    path = folder / "tune.abc"
    path.write_text(ABC.format(key, text))
    return read_abc(path)


@pytest.mark.parametrize(("key", "text", "keys"), [
    ("D", "Tc Tf", [[73, 74], [78, 79]]),
    ("D", "!mordent!A !mordent!B", [[69, 67], [71, 69]]),
    ("D", "Pc ~e !invertedturn!f", [[73, 74], [76, 78, 74], [78, 76, 79]]),
    ("Ddor", "Te TB", [[76, 77], [71, 72]]),
    ("none", "Te T^A", [[76, 77], [70, 71]]),  # B is the note above A sharp, too
    ("D exp _b ^f", "TA Te", [[69, 70], [76, 78]]),
    ("C", "Te ^f Te|Te", [[76, 77], [78], [76, 78], [76, 77]]),  # up to the bar line
    ("C", "^F Te", [[66], [76, 78]]),  # in all octaves, as ABC has it
    ("C", "Te [K:D] Te", [[76, 77], [76, 78]]),
    ("F transpose=2", "TA", [[71, 72]]),
    ("C", "!trill![CE]", [[64, 65]]),
    ("C", "Te-|e2 ^f", [[76, 77], [78]]),
])  # fmt: skip
def test_in_abc(tmp_path, key, text, keys):
    assert keys_of(of_abc(key, text, tmp_path)) == keys


@pytest.mark.parametrize(("text", "keys"), [
    ("1=D 7 \\trill 3' \\trill", [[73, 74], [78, 79]]),
    ("1=D 5 \\mordent 6 \\mordent", [[69, 67], [71, 69]]),
    ("1=D 2' \\turn 3' \\reverseturn 7 \\prall", [[76, 78, 74], [78, 76, 79], [73, 74]]),
    ("6=D 7 \\trill", [[76, 77]]),
    ("3 \\trill #4 \\trill b7 \\trill", [[64, 65], [66, 67], [70, 72]]),
    ("1=C 3 \\trill 1=D 3 \\trill 3 - \\trill", [[64, 65], [66, 67], [66, 67]]),
    ("R{ 1=C 3 \\trill 1=D 3 \\trill }", 2 * [[64, 65], [66, 67]]),
    ("1=F 三 \\trill 六 \\trill", [[62, 65], [69, 72]]),  # of five notes
    ("谱=工尺谱\n工 \\trill 一 \\mordent", [[69, 70], [64, 62]]),
])  # fmt: skip
def test_in_jianpu(text, keys):
    assert keys_of(parse_jianpu(text.encode())) == keys


@pytest.mark.parametrize(("music", "keys"), [
    (attributes(fifths=2) + note("C#5", 1, TRILL) + note("A4", 1, MORDENT), [[73, 74], [69, 67]]),
    (attributes(fifths=2) + note("E5", 1, TURN), [[76, 78, 74]]),
    (note("E5", 1, TRILL) + note("F#5", 1) + note("E5", 1, TRILL), [[76, 77], [78], [76, 78]]),
    (note("F#4", 1) + note("E5", 1, TRILL), [[66], [76, 77]]),  # in its octave alone
    (note("E5", 1, ornament("trill-mark", "sharp")), [[76, 78]]),
    (note("E5", 1, ornament("mordent", "flat")), [[76, 73]]),
    (note("E5", 1, ornament("mordent", "flat", "below")), [[76, 73]]),
    (note("E5", 1, ornament("turn", "sharp")), [[76, 78, 74]]),
    (note("E5", 1, ornament("turn", "sharp", "below")), [[76, 77, 75]]),
    (  # Under a wavy line each note trills with its own neighbour.
        note("D5", 1, WAVY.format("<trill-mark/>", "start"))
        + note("E5", 1, WAVY.format("", "stop")) + note("E5", 1), [[74, 76], [76, 77], [76]],
    ),
])  # fmt: skip
def test_in_musicxml(music, keys):
    assert keys_of(written_of(parse(score(music).encode()))) == keys


def test_an_accidental_that_is_tied_over_a_bar_line_is_of_its_note_alone():
    tied, rest = (
        note("F#5", 4, more='<tie type="start"/>'),
        note("F#5", 1, more='<tie type="stop"/>'),
    )
    written = written_of(parse(score(tied, rest + note("E5", 1, TRILL)).encode()))
    assert keys_of(written) == [[78], [76, 77]]


def test_whatever_is_written_of_a_score_is_played_as_the_score_was(tmp_path):
    tunes = [
        of_abc("D", "Tc Tf !mordent!B ~e|^g Tf ~f =c|[K:Eb] TA PG ~d !fermata!c", tmp_path),
        of_abc("Ador", "TB T^f !mordent!c !invertedturn!g-|!fermata!g2 ~^G2", tmp_path),
        parse_jianpu(b"1=A 4/4 3 \\trill 7 \\turn 1=F 3 \\mordent 4 ~ | 4 \\fermata 5 -"),
        written_of(parse(score(
            attributes(fifths=-3) + note("D5", 2, TRILL) + note("F#5", 1, TRILL)
            + note("E5", 1, ornament("turn", "natural")),
        ).encode())),
    ]  # fmt: skip
    accidentals = {"turn 2": 1, "trill 2": 1}, {}, {"mordent 2": 1}, {"trill 1": 1}
    for written, said in zip(tunes, accidentals, strict=True):
        heard = performed(written).notes
        data, lost = musicxml_of(written)
        assert not lost
        assert performed(written_of(parse(data))).notes == heard
        text, lost = jianpu_of(written)
        # Of jianpu no figure changes the next one in its bar, and keys change at bar lines.
        assert lost == said
        assert lost or performed(parse_jianpu(text.encode())).notes == heard


def test_a_fermata_holds_the_tied_note_over_which_it_stands(tmp_path):
    written = of_abc("C", "d3-|!fermata!d3|B3", tmp_path)
    for each in (
        written,
        written_of(parse(musicxml_of(written)[0])),
        parse_jianpu(jianpu_of(written)[0].encode()),
        parse_jianpu(b"4=60 3/4 2 - - ~ | 2 - - \\fermata 7, - -"),
    ):
        _, second = performed(each).notes
        assert second.start_s == pytest.approx(3.0 + 1.8 * 3.0)
        (tied, _) = each.parts[0].notes
        assert tied.held_from == Fraction(3)
