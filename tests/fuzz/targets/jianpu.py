"""Texts of jianpu and of two-four notation."""

import math

from fuzz.target import target
from fuzz.targets.scores_musicxml import check_written

from yehu_server.errors import ScoreError
from yehu_server.scores.jianpu.reader import MAX_UNKNOWN, parse_jianpu

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
    assert len(written.unknown) <= MAX_UNKNOWN + 1
    check_written(written)
    for part in written.parts:
        assert all(span.begin < span.end for span in part.spans)
        for note in part.notes:
            assert all(0.0 <= grace.pitch <= 127.0 for grace in (*note.before, *note.after))
            shares = [share for share, _ in note.contour]
            assert shares == sorted(shares)
            assert all(0.0 <= share <= 1.0 and math.isfinite(by) for share, by in note.contour)
    beats = [tempo.beat for tempo in written.tempi]
    assert beats == sorted(set(beats))
