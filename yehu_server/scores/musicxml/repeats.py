"""The order in which bars are played: repeats, endings, da capo, dal segno, coda, fine."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass, field

from yehu_server.errors import ScoreError

MOST_BARS = 10_000  # as played
MOST_TIMES = 100
MOST_ENDINGS = 32  # bars of endings on either side of one that are looked at


@dataclass
class BarLines:
    """What a bar says of the order.

    Attributes
    ----------
    times : int
        How often the passage that ends here is played, 2 or more; 0: no repeat ends here.
    endings : frozenset of int
        The passes in which it is played; empty: in all.
    jumps : set of str
        Of dacapo, dalsegno, tocoda and fine, at its end; segno and coda, at its beginning.
    """

    forward: bool = False
    times: int = 0
    endings: frozenset[int] = frozenset()
    jumps: set[str] = field(default_factory=set)


def order_of(bars: Sequence[BarLines]) -> list[int]:
    """Return the numbers of bars, from 0, in the order in which they are played.

    After da capo and dal segno no repeat is taken, and the last of several endings.

    Raises
    ------
    ScoreError
        Where that would be more than MOST_BARS.
    """
    order: list[int] = []
    codas = [at for at, bar in enumerate(bars) if "coda" in bar.jumps]
    at, start, turn = 0, 0, 1
    has_jumped = False
    while at < len(bars):
        bar = bars[at]
        if bar.forward and at != start:
            start, turn = at, 1
        if bar.endings and (has_jumped or turn not in bar.endings):
            group = _group(bars, at)
            last = max(max(bars[each].endings) for each in group)
            if not has_jumped or last not in bar.endings:
                at += 1
                continue
        order.append(at)
        if len(order) > MOST_BARS:
            raise ScoreError(f"has more than {MOST_BARS} bars, with its repeats")
        if has_jumped and "fine" in bar.jumps:
            break
        if has_jumped and "tocoda" in bar.jumps:
            after = bisect_right(codas, at)
            if after < len(codas):
                at = codas[after]
                continue
        if bar.times and not has_jumped:
            if turn < _turns(bars, at):
                at, turn = start, turn + 1
                continue
            start, turn = at + 1, 1
        elif "fine" in bar.jumps:  # what follows is a trio, with repeats of its own
            start, turn = at + 1, 1
        if not has_jumped and not bar.jumps.isdisjoint(("dacapo", "dalsegno")):
            has_jumped = True
            at = start = _segno(bars) if "dalsegno" in bar.jumps else 0
            continue
        at += 1
    return order


def _turns(bars: Sequence[BarLines], at: int) -> int:
    """How often the passage is played that a repeat ends."""
    if not bars[at].endings:
        return min(bars[at].times, MOST_TIMES)
    endings = {bars[each].endings for each in _group(bars, at)}
    last = max(max(each) for each in endings)
    return min(last if len(endings) > 1 else last + 1, MOST_TIMES)


def _group(bars: Sequence[BarLines], at: int) -> range:
    """The bars with endings around one."""
    first = last = at
    while first > 0 and bars[first - 1].endings and at - first < MOST_ENDINGS:
        first -= 1
    while last + 1 < len(bars) and bars[last + 1].endings and last - at < MOST_ENDINGS:
        last += 1
    return range(first, last + 1)


def _segno(bars: Sequence[BarLines]) -> int:
    """The bar of the first segno; without one, the first bar."""
    return next((at for at, bar in enumerate(bars) if "segno" in bar.jumps), 0)
