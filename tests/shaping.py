"""Scores as a player shapes them, for tests."""

from dataclasses import replace

from yehu_server.playing.options import PlayingOptions
from yehu_server.scores import phrasing
from yehu_server.scores.score import Score

USUAL = PlayingOptions()


def phrased(
    score: Score, amount: float, playing: PlayingOptions = USUAL, rubato: float | None = None
) -> Score:
    return phrasing.phrased(score, replace(playing, phrasing=amount, rubato=rubato))
