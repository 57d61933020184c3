"""Beats as readers count them: in whole ticks, which are added far sooner than fractions are.

What is no whole number of ticks stays a fraction of them, so that all beats are exact.
"""

from fractions import Fraction
from functools import lru_cache

from yehu_server.scores.score import Metre

TICKS = 2**9 * 3**2 * 5**2 * 7 * 11  # of a quarter note
FINEST = 1 << 24  # the smallest part of a tick is this one

Ticks = int | Fraction


def ticks_of(quarters: Fraction) -> Ticks:
    """Quarters as ticks."""
    return scaled(TICKS, quarters)


def scaled(ticks: Ticks, factor: Fraction) -> Ticks:
    """So many times as many ticks."""
    whole, rest = divmod(ticks * factor.numerator, factor.denominator)
    return ticks * factor if rest else whole


def quarters_of(ticks: Ticks) -> Fraction:
    """Ticks as quarters."""
    return Fraction(ticks, TICKS)


length_of = lru_cache(maxsize=4096)(quarters_of)  # for lengths, most of which are alike


def metre_at(begin: Ticks, length: Ticks) -> Metre:
    """A metre from a beat on, whose bars are so long."""
    return Metre(float(begin / TICKS), float(length / TICKS))


def bounded(ticks: Ticks) -> Ticks:
    """A beat that is no finer than FINEST: fractions of many kinds together would grow on."""
    return ticks if ticks.denominator <= FINEST else Fraction(round(ticks * FINEST), FINEST)
