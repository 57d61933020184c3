"""The picture of a score as it will be bowed: strokes and strings as the player has them."""

from fractions import Fraction
from unittest.mock import Mock

import numpy as np
import pytest

from yehu_server.plot import png
from yehu_server.plot.bowed_score import BOW, LOUD, string_of, write_bowed_score
from yehu_server.plot.strokes import strokes_of
from yehu_server.scores.jianpu.reader import parse_jianpu
from yehu_server.scores.written.mark_settings import DOWN, UP
from yehu_server.scores.written.notated import Mark, Note


def test_the_bow_turns_with_each_stroke_and_stays_under_slurs(subtests):
    pizz = '1 2 ^"pizz." 3 4 ^"arco" 1'
    for text, expected in (
        ("1 2 3 4", [(0, 0, DOWN), (1, 1, UP), (2, 2, DOWN), (3, 3, UP)]),
        ("1 ( 2 3 ) 4", [(0, 2, DOWN), (3, 3, UP)]),
        ("1 ( 2 ) 3 ( 4 )", [(0, 1, DOWN), (2, 3, UP)]),
        ("1 \\upbow 2 3", [(0, 0, UP), (1, 1, DOWN), (2, 2, UP)]),
        ("1 2 \\downbow 3", [(0, 0, DOWN), (1, 1, DOWN), (2, 2, UP)]),
        (pizz, [(0, 0, DOWN), (1, 1, 0), (2, 2, 0), (3, 3, UP), (4, 4, DOWN)]),
        ("1 ( 1 ) 2", [(0, 1, DOWN), (2, 2, UP)]),  # repeated under a slur: it goes on
        ('1 ^"legato" 2 3 ^"non legato" 4', [(0, 2, DOWN), (3, 3, UP)]),
        ("4=30 1 - - - 2", [(0, 0, DOWN, UP), (1, 1, DOWN)]),  # the bow has an end
        ("4=60 1 - 2 3", [(0, 0, DOWN), (1, 1, UP), (2, 2, DOWN)]),
    ):
        with subtests.test(text):
            found = strokes_of(parse_jianpu(text.encode()), 0, phrasing=0.0)
            assert [(each.first, each.last, each.direction, *each.turns) for each in found] == (
                expected
            )


def test_a_note_is_on_the_string_where_the_player_has_it():
    for pitch, string, *marks in (
        *((65.0, "F open"), (72.0, "C open"), (71.0, "F"), (74.0, "C")),
        *((74.0, "F", Mark("inner-string")), (72.0, "F", Mark("finger", 4.0))),
    ):
        assert string_of(Note(Fraction(0), Fraction(1), pitch, tuple(marks))) == string


def test_a_score_is_drawn_and_its_picture_replaced_by_that_of_another(
    command, refused, tmp_path, everything
):
    pytest.importorskip("matplotlib")
    tune, target = tmp_path / "t.jianpu", tmp_path / "score.png"
    tune.write_text("title=短\n1=F 4/4,4 1 3[ q1 q2 q3 ] R*1 5' - - -\nNextPart\n0 0\n", "utf-8")
    words = ("score", "show", tune, "--plot", target)
    assert command(*words)[0] == 0
    data = target.read_bytes()
    assert data.startswith(b"\x89PNG")
    if everything:
        assert command(*words)[0] == 0
        assert target.read_bytes() == data  # the same again
    tune.write_text(tune.read_text("utf-8").replace("q3", "q5"), "utf-8")
    assert command(*words)[0] == 0  # its own picture is replaced
    assert target.read_bytes() != data
    assert "a picture is a .png file" in refused(*words[:-1], tmp_path / "score.pdf")
    assert "has no part Flute" in refused(*words, "--part", "Flute")


@pytest.fixture
def drawn(monkeypatch, tmp_path):
    """Draw a jianpu text: for each line of the picture its texts, and its curves in order."""

    panels = [Mock(), Mock()]
    figure = Mock(subplots=lambda rows, *_, **__: np.array(panels[:rows]).reshape(-1, 1))
    monkeypatch.setattr(png, "write_picture", lambda _to, _size, fill, **_: fill(figure))

    def draw(text):
        for each in panels:
            each.reset_mock()
        write_bowed_score(parse_jianpu(text.encode()), 0, tmp_path / "score.png")
        texts = [[call.args[2] for call in each.text.call_args_list] for each in panels]
        curves = [
            [(*map(list, call.args[:2]), call.kwargs["color"]) for call in each.plot.call_args_list]
            for each in panels
        ]
        return [*zip(texts, curves, strict=True)]

    return draw


def test_a_hairpin_that_ends_within_a_tied_note_opens_to_its_own_side(drawn):
    for sign, is_wide_first in (("\\>", True), ("\\<", False)):
        (_, curves), _ = drawn(f"3/4 5 {sign} - - ~ | 5 - \\! - | 1 - -")
        for xs, ys, color in curves:
            if color == LOUD:
                assert (ys[0] == -1.85) == (xs[0] > xs[1] if is_wide_first else xs[0] < xs[1])
                assert max(xs) > 1.0  # in the second bar


def test_each_mark_of_an_ornament_and_each_slide_and_change_of_tempo_is_drawn(drawn):
    (texts, _), _ = drawn(
        '1 \\turn 2 \\reverseturn 3 \\mordent 4 \\prall | 1 ^"rit." 2 3 \\glissando 4 |'
    )
    assert {"turn", "inv. turn", "mord.", "inv. mord.", "rit.", "gliss."} <= {*texts}


def test_a_brace_goes_on_open_in_the_next_line(drawn):
    braces = [
        [ys for _, ys, color in curves if color == BOW and len(ys) > 1]
        for _, curves in drawn("4=200 4/4 1 2 3 4 | 1 2 3 4 | 1 2 3 4 | 1 2 3 4 ( | 3 ) 2 1 - |")
    ]
    assert [len(ys) for ys in braces[0]] == [3]  # one end
    assert braces[0][-1][0] < braces[0][-1][-1]
    assert braces[1][0] == braces[0][-1][::-1]
