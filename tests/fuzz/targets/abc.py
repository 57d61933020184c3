"""Tunes of ABC, and how they are played and written in other notations."""

from fuzz.target import target, written
from fuzz.targets.scores_musicxml import check

from yehu_server.errors import ScoreError
from yehu_server.scores.abc.reader import read_abc

WORDS = """
X:1 T:a M:6/8 M:C| M:none L:1/16 L:1/0 Q:1/4=120 Q:"Allegro" K:C K:F#m K:Bbdor K:HP K:none
[K:D] [M:3/4] [L:1/4] [V:2] V:1 V:2 P:AB P:(AB)2 w:la U:T=!trill! m:~a=b |: :| :: |] || [1 [2
|1 :|2 (3 (5:4:5 (9 > < >> - ( ) {g} {/gab} [CEG] [C2E] ^ ^^ _ __ = C D e f' g'' A, B,, z4 x Z8 y
C3/2 D// E/4 !trill! !segno! !D.S.! !coda! !fine! !<(! !<)! !p! !fermata! !1! ~ . H L M O P S T u v
"^pizz." "Am" & %
"""


@target(
    "abc", ScoreError, words=(*(f"{word} ".encode() for word in WORDS.split()), b"\n", b"\n\nX:2\n")
)
def abc(data: bytes) -> None:
    """A file is a tune of notes in order, within bounds, that can be played, or a ScoreError."""
    check(read_abc(written(data, "file.abc")))
