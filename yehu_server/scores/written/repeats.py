"""The order in which bars are played: repeats, endings, da capo, dal segno, coda, fine.

First the repeated passages are found, also where signs are missing: a repeat without a beginning
begins where the one before it ended, or at the last double bar line of ABC, an ending reaches up to
its repeat, or has one where another ending follows. Then bars are played in the order in which a
player reads them.
"""

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass, field

from yehu_server.errors import ScoreError

MAX_BARS = 10_000  # as played
MAX_TIMES = 100
ENDS = {"fine", "dacapo", "dalsegno"}  # after which something else begins


@dataclass
class BarLines:
    """The signs of a bar for the order."""

    forward: bool = False
    # How often the passage that ends here is played, 2 or more; 0: no repeat ends here.
    times: int = 0
    endings: frozenset[int] = frozenset()  # the passes in which it is played; empty: in all
    opens: bool = False  # whether an ending begins here
    # Of dacapo, dalsegno, tocoda and fine, at its end; segno and coda, at its beginning.
    jumps: set[str] = field(default_factory=set)
    # Whether a double bar line stands before it, to which a repeat without a beginning goes back.
    double: bool = False


@dataclass
class _Ending:
    """Bars of one ending, both included, and the passes in which they are played."""

    first: int
    last: int
    passes: set[int]


@dataclass
class _Passage:
    """Bars that are repeated, both included; its endings are at its end."""

    first: int
    last: int
    times: int
    endings: list[_Ending] = field(default_factory=list)

    def repeats_at(self, bar: int) -> bool:
        """Whether a pass may end with a bar, and another begin."""
        if not self.endings:
            return bar == self.last
        return any(bar == ending.last for ending in self.endings)


@dataclass
class _Level:
    """The beginning of repeats: the bar of the last sign, or the one that replaces it."""

    base: int
    sign: int | None = None


def order_of(bars: Sequence[BarLines]) -> list[int]:
    """Return the numbers of bars, from 0, in the order in which they are played.

    After da capo and dal segno no repeat is taken, and the last of several endings, up to the bar
    from which was jumped. Each jump is taken once. Where Fine ends the music before its last bars
    were played, it goes on with those, as with another movement. Raises ScoreError where that would
    be more than MAX_BARS.
    """
    return _Unfolder(bars, _passages(bars)).order()


def left_out(count: int, order: Sequence[int]) -> list[int]:
    """Return the numbers of bars, of so many, that an order never plays."""
    return sorted({*range(count)} - {*order})


# -- passages -----------------------------------------------------------------------------------


def _passages(bars: Sequence[BarLines]) -> list[_Passage]:
    """Find all passages that are repeated, outer ones before inner ones."""
    groups = {group[0].first: group for group in _groups(bars)}
    found: list[_Passage] = []
    levels = [_Level(0)]  # the last is that of the ending that is open
    open_: list[tuple[_Passage, int]] = []  # with the number of the ending
    for at, bar in enumerate(bars):
        if at in groups:
            outer = levels[-1]
            first = min(outer.base, at) if outer.sign is None else outer.sign
            group = groups[at]
            passage = _Passage(first, group[-1].last, max(max(e.passes) for e in group), group)
            if len(group) == 1:
                passage.times += 1  # the last time without it
            passage.times = min(passage.times, MAX_TIMES)
            found.append(passage)
            outer.sign = None
            open_.append((passage, 0))
            levels.append(_Level(at))
        elif open_:
            passage, number = open_[-1]
            if number + 1 < len(passage.endings) and at == passage.endings[number + 1].first:
                open_[-1] = passage, number + 1
                levels[-1] = _Level(at)
        level = levels[-1]
        if bar.double and level.sign is None:
            level.base = at
        if bar.forward and not (len(levels) > 1 and at == open_[-1][0].first):
            level.sign = at
        ends = bool(open_) and at == open_[-1][0].endings[open_[-1][1]].last
        if bar.times and (level.sign is not None or not (ends or len(levels) > 1)):
            first = level.base if level.sign is None else level.sign
            found.append(_Passage(first, at, min(bar.times, MAX_TIMES)))
            level.base, level.sign = at + 1, None
        elif bar.jumps & ENDS and level.sign is None and len(levels) == 1:
            level.base = at + 1  # what follows, such as a trio, has repeats of its own
        if ends and at == open_[-1][0].last:
            inner, _ = levels.pop(), open_.pop()
            levels[-1].base, levels[-1].sign = at + 1, inner.sign
    return sorted(found, key=lambda passage: (passage.first, -passage.last))


def _groups(bars: Sequence[BarLines]) -> list[list[_Ending]]:
    """Endings that follow each other, of one passage."""
    endings = [_shaped(bars, ending) for ending in _endings(bars)]
    groups: list[list[_Ending]] = []
    for number, ending in enumerate(endings):
        after = endings[number + 1] if number + 1 < len(endings) else None
        _reach_repeat(bars, ending, after)
        before = groups[-1][-1] if groups else None
        follows = before is not None and before.last + 1 == ending.first
        taken = {each for other in groups[-1] for each in other.passes} if groups else {0}
        if follows and min(ending.passes) > min(taken) and taken.isdisjoint(ending.passes):
            groups[-1].append(ending)
        else:
            groups.append([ending])
    kept = [group for group in groups if len(group) > 1 or bars[group[0].last].times]
    for group in kept:
        _fill_passes(group)
    return kept


def _endings(bars: Sequence[BarLines]) -> list[_Ending]:
    found: list[_Ending] = []
    for at, bar in enumerate(bars):
        if not bar.endings:
            continue
        last = found[-1] if found else None
        goes_on = last is not None and last.last + 1 == at and not bar.opens
        if last is not None and goes_on and last.passes == {*bar.endings}:
            last.last = at
        else:
            found.append(_Ending(at, at, {*bar.endings}))
    return found


def _shaped(bars: Sequence[BarLines], ending: _Ending) -> _Ending:
    """End an ending at its repeat, where its line is drawn beyond."""
    depth = 0
    for at in range(ending.first, ending.last):
        depth += bars[at].forward
        if bars[at].times and not depth:
            ending.last = at
        elif bars[at].times:
            depth = 0
        if ending.last == at:
            break
    return ending


def _reach_repeat(bars: Sequence[BarLines], ending: _Ending, after: _Ending | None) -> None:
    """Draw an ending on up to its repeat, where its line is too short and another follows."""
    if after is None or bars[ending.last].times or min(after.passes) <= max(ending.passes):
        return
    between = range(ending.last + 1, after.first)
    if between and bars[between[-1]].times and not any(bars[at].forward for at in between):
        ending.last = between[-1]


def _fill_passes(group: list[_Ending]) -> None:
    """Let each pass have an ending: where none has its number, the one before it."""
    for number in range(1, max(max(ending.passes) for ending in group)):
        if not any(number in ending.passes for ending in group):
            before = [ending for ending in group if min(ending.passes) <= number]
            (before or group)[-1 if before else 0].passes.add(number)


# -- playing ------------------------------------------------------------------------------------


class _Unfolder:
    def __init__(self, bars: Sequence[BarLines], passages: list[_Passage]) -> None:
        self._bars = bars
        self._passages = {id(passage): passage for passage in passages}
        self._beginning: dict[int, list[_Passage]] = {}
        self._ending: dict[int, list[_Passage]] = {}  # passes may end here; inner ones first
        self._choices: dict[int, tuple[_Passage, _Ending]] = {}
        for passage in passages:
            self._beginning.setdefault(passage.first, []).append(passage)
            ends = {passage.last} | {ending.last for ending in passage.endings}
            for at in ends:
                self._ending.setdefault(at, []).insert(0, passage)
            for ending in passage.endings:
                self._choices[ending.first] = passage, ending
        self._codas = [at for at, bar in enumerate(bars) if "coda" in bar.jumps]
        self._passes: dict[int, int] = {}  # of the passages that are open, by `id`
        self._taken: set[int] = set()  # bars from which was jumped
        self._from: int | None = None  # where the last jump began, until it is reached again
        self._movement = 0

    def order(self) -> list[int]:
        """All bars as they are played."""
        order: list[int] = []
        at = 0
        while at < len(self._bars):
            for passage in self._beginning.get(at, ()):
                self._passes.setdefault(id(passage), passage.times if self._is_again else 1)
            chosen = self._choices.get(at)
            if chosen is not None:
                passage, ending = chosen
                if self._passes.get(id(passage), 0) not in {0, *ending.passes}:
                    at = ending.last + 1
                    if ending is passage.endings[-1]:
                        self._passes.pop(id(passage), None)
                    continue
            order.append(at)
            if len(order) > MAX_BARS:
                raise ScoreError(f"has more than {MAX_BARS} bars, with its repeats")
            at = self._after(at)
        return order

    @property
    def _is_again(self) -> bool:
        return self._from is not None

    def _after(self, at: int) -> int:
        """The bar to play after one."""
        jumps = self._bars[at].jumps
        if self._from is not None and "fine" in jumps:
            self._movement = self._from + 1
            return self._go(self._movement, to_normal=True)
        if self._is_again and "tocoda" in jumps:
            after = bisect_right(self._codas, at)
            if after < len(self._codas):
                return self._go(self._codas[after], to_normal=True)
        for passage in self._ending.get(at, ()):
            turn = self._passes.get(id(passage))
            if turn is None:
                continue
            if turn < passage.times and passage.repeats_at(at):
                self._passes[id(passage)] = turn + 1
                for key in list(self._passes):
                    inner = self._passages[key]
                    if inner is not passage and passage.first <= inner.first <= inner.last <= at:
                        del self._passes[key]
                return passage.first
            if at == passage.last:
                del self._passes[id(passage)]
        if at not in self._taken and not jumps.isdisjoint(("dacapo", "dalsegno")):
            if all(turn >= self._passages[key].times for key, turn in self._passes.items()):
                self._taken.add(at)
                self._from = at
                return self._go(self._segno(at) if "dalsegno" in jumps else self._movement)
        elif self._from is not None and at >= self._from:
            self._from = None
        return at + 1

    def _go(self, to: int, *, to_normal: bool = False) -> int:
        """Jump to a bar; within a passage, in its last pass."""
        if to_normal:
            self._from = None
        self._passes = {
            id(each): each.times
            for each in self._passages.values()
            if each.first <= to <= each.last
        }
        if to_normal:  # what begins here begins anew
            for each in self._beginning.get(to, ()):
                self._passes[id(each)] = 1
        return to

    def _segno(self, before: int) -> int:
        """The last segno up to a bar; else the beginning: to one ahead, bars would be lost."""
        found = [at for at in range(before + 1) if "segno" in self._bars[at].jumps]
        return found[-1] if found else self._movement
