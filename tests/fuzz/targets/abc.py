"""Tunes in ABC."""

from __future__ import annotations

from fuzz.target import target, written
from fuzz.targets.scores_musicxml import check_played, check_written

from yehu_server.errors import ScoreError
from yehu_server.scores.abc.reader import read_abc

WORDS = """
X:1 K:G M:6/8 L:1/8 Q:1/4=120 P:AB(AB)3 V:1 V:2 T: |: :| [1 [2 :|2 || |] (3abc (5:4:6 {gfe} {/g}
^f _B =c c'' C,, z4 z1/3 A3/2 A>B A<<B -| ( ) [CEG] !trill! !uppermordent! !crescendo(! !fermata!
u v ~ .A "Am" "^text" [K:Dm] [M:5/4] [Q:1/4=60] %%MIDI %abc-2.1 \\ & w: s: U: y x
"""


@target("abc", ScoreError, words=tuple(f" {word} ".encode() for word in WORDS.split()))
def abc(data: bytes) -> None:
    """A file is a tune of notes in order, within bounds, that can be played, or a ScoreError."""
    score = read_abc(written(data, "file.abc"))
    check_written(score)
    check_played(score)
