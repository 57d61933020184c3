"""Two-four notation of Chaozhou, and gongche notation."""

from fractions import Fraction
from itertools import pairwise
from pathlib import Path

import pytest

from yehu_server.errors import ScoreError
from yehu_server.scores.jianpu.reader import parse_jianpu, read_jianpu
from yehu_server.scores.written.notated import Note

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "huo_wu.jianpu"
DO = 65.0  # F4


def notes(text: str) -> list[Note]:
    score = parse_jianpu(text.encode())
    assert not score.unknown
    assert not score.warnings
    return list(score.parts[0].notes)


def steps(text: str) -> list[float]:
    """Semitones above F4."""
    return [round(note.pitch - DO, 6) for note in notes(text)]


def test_the_seven_characters_are_sol_la_do_re_mi_sol_la_in_f_or_a_written_key():
    assert steps("二 三 四 五 六 七 八") == [-5, -3, 0, 2, 4, 7, 9]
    assert [note.pitch for note in notes("1=D 四 1")] == [62.0, 62.0]


def test_lengths_octaves_and_marks_are_those_of_jianpu():
    first, second = notes("q.五, s四' \\upbow")
    assert (first.pitch - DO, first.length) == (-10.0, Fraction(3, 4))
    assert (second.pitch - DO, second.length) == (12.0, Fraction(1, 4))
    assert second.marks[0].name == "up-bow"
    in_one_word = [(note.pitch - DO, float(note.length)) for note in notes("q四五六")]
    assert in_one_word == [(0.0, 0.5), (2.0, 0.5), (4.0, 0.5)]


def test_the_mode_says_which_of_three_and_six_is_heavy():
    for mode, heard in {
        "轻六": [-3.0, 4.0],
        "重六": [-1.5, 5.3],
        "重三六调": [-1.5, 5.3],
        "轻三重六": [-3.0, 5.3],
        "zhong-liu": [-1.5, 5.3],
        "活五": [-1.5, 5.3],
    }.items():
        assert steps(f"mode={mode}\n三 六") == steps(f"调={mode}\n三 六") == heard, mode


def test_the_living_five_is_raised_and_slides_up_from_re():
    (note,) = notes("mode=活五\n五 - - -")
    assert note.pitch - DO == 2.75
    times, depths = zip(*note.contour, strict=True)
    assert note.pitch + depths[0] - DO == 2.0  # from re
    assert max(depths) > 0.2  # past its pitch
    assert depths[-1] == 0.0
    turns = [one for one, other in pairwise(depths) if one * other < 0]
    assert len(turns) >= 4  # unstable
    assert times == tuple(sorted(times))
    (alone,) = notes("活五 - - -")  # in any mode
    assert alone == note


def test_a_mode_that_nobody_knows_is_named_and_the_example_is_understood_whole():
    assert dict(parse_jianpu("mode=活六\n四".encode()).unknown) == {"mode=活六": 1}
    score = read_jianpu(EXAMPLE)
    assert not score.unknown
    assert not score.warnings
    assert sum(bool(note.contour) for note in score.parts[0].notes) >= 6


def test_gongche_characters_are_read_where_that_is_said():
    assert steps("notation=工尺谱\n合 四 一 上 尺 工 凡 六 五 乙 仩") == [
        -5, -3, -1, 0, 2, 4, 5, 7, 9, 11, 12,
    ]  # fmt: skip
    with pytest.raises(ScoreError, match="line 2, column 3: there is no 八 in this notation"):
        parse_jianpu("notation=工尺谱\n上 八".encode())
