"""Texts of jianpu and of two-four notation."""

from __future__ import annotations

import math

from fuzz.target import target

from yehu_server.errors import ScoreError
from yehu_server.scores.jianpu.reader import MOST_UNKNOWN, parse_jianpu
from yehu_server.scores.written.notated import MARKS, SIGNS, SPANS

WORDS = """
title= notation=工尺谱 mode=活五 1=F 6=D 4/4 3/4,4 4=96 4.=60 NextPart NextScore R{ R3{ R100{ A{ | }
3[ ] g[#4d5] ['1]g 1///5 Fr= Harm: :Harm KeepLength OctavesAfter OctavesBefore slideUp glis DC DS
Fine Segno ToCoda R*8 \\p \\< \\! \\trill ^"pizz." ^"渐慢" ^"a tempo" ( ) ~ q s d h - . ' , # b < >
二 三 四 五 六 七 八 轻 重 活 合 L: LP: :LP chords= %
"""


@target(
    "jianpu",
    ScoreError,
    words=tuple(f" {word} ".encode() for word in WORDS.split()),
    also=("examples/*.jianpu",),
)
def jianpu(data: bytes) -> None:
    """A text gives notes in order, with known marks and finite pitches, or a ScoreError."""
    written = parse_jianpu(data)
    assert any(part.notes for part in written.parts)
    assert len(written.unknown) <= MOST_UNKNOWN + 1
    for line in (written.title, *written.unknown, *written.warnings):
        assert line.isprintable()
    for part in written.parts:
        end = 0
        for note in part.notes:
            assert note.beat >= end
            assert note.length > 0
            assert 0.0 <= note.pitch <= 127.0
            assert all(0.0 <= grace.pitch <= 127.0 for grace in (*note.before, *note.after))
            assert all(mark.name in MARKS for mark in note.marks)
            shares = [share for share, _ in note.contour]
            assert shares == sorted(shares)
            assert all(0.0 <= share <= 1.0 and math.isfinite(by) for share, by in note.contour)
            end = note.end
        assert all(span.name in SPANS and span.begin < span.end for span in part.spans)
        assert all(sign.name in SIGNS for sign in part.signs)
    beats = [tempo.beat for tempo in written.tempi]
    assert beats == sorted(set(beats))
