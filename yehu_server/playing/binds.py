"""One bind: a source that moves a target, how far, along which curve and under which terms."""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass

from yehu_server.params.spec import Curve
from yehu_server.params.table import find
from yehu_server.playing import sources

NEAR = 1.0 / 64.0  # how near a controller comes to its target to pick it up


@dataclass(frozen=True)
class Table:
    """A curve by its points: of the controller's way, 0 to 1, and of the span, 0 to 1.

    The first are strictly rising, from 0 to 1; straight lines join the points.
    """

    points: tuple[tuple[float, float], ...]

    @property
    def value(self) -> list[list[float]]:
        """As a file has it."""
        return [list(point) for point in self.points]

    def at(self, unit: float) -> float:
        """The share of the span at a place of the way."""
        after = bisect_right(self.points, unit, key=lambda point: point[0])
        after = min(max(after, 1), len(self.points) - 1)
        (x0, y0), (x1, y1) = self.points[after - 1], self.points[after]
        return y1 if unit >= x1 else y0 + (y1 - y0) * (unit - x0) / (x1 - x0)

    def bend(self, unit: float, lo: float, hi: float) -> float:
        """See `Curve.bend`."""
        return lo + (hi - lo) * self.at(unit)

    def share(self, value: float, lo: float, hi: float) -> float:
        """The share of the span at a value; a value beyond what the table reaches is at its end."""
        shares = [share for _, share in self.points]
        return min(max(Curve.LIN.unbend(value, lo, hi), min(shares)), max(shares))

    def unbend(self, value: float, lo: float, hi: float) -> float:
        """See `Curve.unbend`; the first such place where the table turns back."""
        share = self.share(value, lo, hi)
        for (x0, y0), (x1, y1) in zip(self.points, self.points[1:], strict=False):
            if y0 == share:
                return x0
            if min(y0, y1) <= share <= max(y0, y1):
                return x0 + (x1 - x0) * (share - y0) / (y1 - y0)
        return 1.0  # by rounding, past the last point


@dataclass(frozen=True)
class Bind:
    """One source that moves one parameter.

    The source's way, 0 to 1, is spread over `span` along `curve`; a span from high to low
    inverts, as does `invert`. Without a span the bend is in semitones, by the bend range.

    Attributes
    ----------
    source : str
        By its canonical name (``sources``).
    smoothing_ms : float
        The least time a move takes; see `Performer.write`.
    channels : tuple of int
        The MIDI channels that are heard, as people count; all where none is named.
    is_soft : bool
        Whether the target moves only once the source has come to where it is.
    reach : tuple of float
        The values that an OSC address sends at the two ends of its way.
    is_alone : bool
        Whether nothing of a base moves the target.
    is_global : bool
        Whether it moves every note, wherever the source is moved; see ``scope``.
    """

    source: str
    target: str
    span: tuple[float, float] | None = None
    curve: Curve | Table = Curve.LIN
    invert: bool = False
    smoothing_ms: float = 0.0
    channels: tuple[int, ...] = ()
    is_soft: bool = False
    reach: tuple[float, float] = (0.0, 1.0)
    is_alone: bool = False
    is_global: bool = False

    @property
    def is_by_range(self) -> bool:
        """Whether it spans what the bend range (RPN 0) says."""
        return self.source == "bend" and self.span is None and self.target == "/playing/bend"

    @property
    def ends(self) -> tuple[float, float]:
        """The target's values at the two ends of the source's way, before `invert`."""
        param = find(self.target)
        return self.span or (param.lo, param.hi)

    @property
    def way(self) -> tuple[float, float]:
        """The target's values where the source is at 0 and at 1."""
        return self.ends[::-1] if self.invert else self.ends

    @property
    def curve_name(self) -> str:
        """The curve in a word."""
        return self.curve.value if isinstance(self.curve, Curve) else "table"

    @property
    def terms(self) -> tuple[str, ...]:
        """What else goes for it, for reading."""
        terms = []
        if self.reach != (0.0, 1.0):
            terms.append(f"sends {self.reach[0]:g} to {self.reach[1]:g}")
        if self.channels:
            terms.append(f"channel {', '.join(map(str, self.channels))}")
        if self.smoothing_ms:
            terms.append(f"within {self.smoothing_ms:g} ms")
        if self.is_soft:
            terms.append("soft")
        if self.is_alone:
            terms.append("alone")
        if self.is_global:
            terms.append("global")
        return tuple(terms)

    def hears(self, channel: int) -> bool:
        """Whether it is for a channel, counted from 0 over all ports; below 0 is no channel."""
        return not self.channels or (
            channel >= 0 and channel % sources.CHANNELS + 1 in self.channels
        )

    def place(self, argument: float) -> float:
        """Where an OSC argument is on the way, 0 to 1."""
        return Curve.LIN.unbend(argument, *self.reach)

    def apply(self, place: float) -> float:
        """Map the source's place, 0 to 1, to the target's value."""
        return self.curve.bend(self._turned(place), *self.ends)

    def place_of(self, value: float) -> float:
        """Find the place, 0 to 1, that `apply` maps to a value; one beyond an end is at it."""
        return self._turned(self.curve.unbend(value, *self.ends))

    def semitones(self, place: float, bend_range: float) -> float:
        """Map the place of a wheel whose ends are the bend range."""
        return (2.0 * self.curve.bend(self._turned(place), 0.0, 1.0) - 1.0) * bend_range

    def meets(self, place: float, before: float | None, value: float) -> bool:
        """Whether a source that comes to a place is, or passed, where the target is.

        Parameters
        ----------
        before : float, optional
            Its place before, if it was ever moved.
        value : float
            The target's.
        """
        here, there = self._share(place), self._share_of(value)
        if abs(here - there) <= NEAR or self.ends[0] == self.ends[1]:
            return True
        return before is not None and (self._share(before) - there) * (here - there) < 0.0

    def _turned(self, place: float) -> float:
        return 1.0 - place if self.invert else place

    # A table may turn back or stand still, so places are compared by what comes of them.

    def _share(self, place: float) -> float:
        turned = self._turned(place)
        return self.curve.at(turned) if isinstance(self.curve, Table) else turned

    def _share_of(self, value: float) -> float:
        way = self.curve.share if isinstance(self.curve, Table) else self.curve.unbend
        return way(value, *self.ends)


def replaced(bind: Bind) -> tuple[str, tuple[int, ...]]:
    """What a bind stands for: one of the same in a file replaces those of the file's base."""
    return sources.controller(bind.source), bind.channels
