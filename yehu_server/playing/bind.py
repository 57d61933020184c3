"""A bind: one source that moves one target, over what range, along which curve, for which notes."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from types import SimpleNamespace
from typing import Any

from yehu_server.compile.jit import uncompiled
from yehu_server.core.midi import curves
from yehu_server.core.midi.tables import EXPONENTIAL, LINEAR, POINTS, S
from yehu_server.params.spec import Curve
from yehu_server.params.table import find
from yehu_server.playing import sources

CURVES: dict[Any, int] = {Curve.LIN: LINEAR, Curve.EXP: EXPONENTIAL, Curve.S: S}  # in tables


@dataclass(frozen=True)
class Breakpoints:
    """A curve of straight lines between points (position, fraction), both 0 to 1.

    Positions rise strictly from 0 to 1; fractions may fall or stay the same.
    """

    points: tuple[tuple[float, float], ...]

    @property
    def value(self) -> list[list[float]]:
        """The points as a file has them."""
        return [list(point) for point in self.points]


@dataclass(frozen=True)
class Bind:
    """One source that moves one parameter.

    The source's position, 0 to 1, is mapped to `span` along `curve`; a span from high to low
    inverts, as does `invert`. The pitch wheel without a span moves ``/playing/bend`` in
    semitones, by the bend range.
    """

    source: str  # canonical name of the source (``sources``)
    target: str  # address of the parameter
    # The target's values at the two ends; by default its whole range.
    span: tuple[float, float] | None = None
    curve: Curve | Breakpoints = Curve.LIN
    invert: bool = False
    # Shortest time in which a move changes a sounding note; see `Player.write`.
    smoothing_ms: float = 0.0
    channels: tuple[int, ...] = ()  # MIDI channels, 1 to 16, that it receives on; all if empty
    # Soft take-over: the target moves only once the source has reached the target's value.
    is_soft: bool = False
    # The values that an OSC address sends at its two ends.
    input_range: tuple[float, float] = (0.0, 1.0)
    # The part, from 1, that an OSC address moves where it is sent without one; 0: the first of all.
    part: int = 0
    # Whether it replaces all binds of the base that move the same target; ``alone`` in files.
    is_exclusive: bool = False
    # Whether it moves every note, on whichever port and channel the source is moved; see ``scope``.
    is_global: bool = False
    # Whether MIDI learn made it; `unlearn` removes it before those that the user wrote.
    is_learned: bool = False
    # Binds of the same file that MIDI learn took away for it; they come back with `unlearn`.
    replaces: tuple[Bind, ...] = ()

    @property
    def is_by_range(self) -> bool:
        """Whether the bend range (RPN 0) sets its span."""
        return self.source == "bend" and self.span is None and self.target == "/playing/bend"

    @property
    def ends(self) -> tuple[float, float]:
        """The target's values at the two ends of the span, before `invert`."""
        param = find(self.target)
        return self.span or (param.lo, param.hi)

    @property
    def output_range(self) -> tuple[float, float]:
        """The target's values where the source is at 0 and at 1."""
        return self.ends[::-1] if self.invert else self.ends

    @property
    def curve_name(self) -> str:
        """Name of the curve, for reading."""
        return self.curve.value if isinstance(self.curve, Curve) else "table"

    @property
    def terms(self) -> tuple[str, ...]:
        """All settings that are not at their defaults, beside span and curve, for reading."""
        lo, hi = self.input_range
        terms = {
            f"sends {lo:g} to {hi:g}": (lo, hi) != (0.0, 1.0),
            f"part {self.part}": self.part,
            f"channel {', '.join(map(str, self.channels))}": self.channels,
            f"within {self.smoothing_ms:g} ms": self.smoothing_ms,
            "soft": self.is_soft,
            "alone": self.is_exclusive,
            "global": self.is_global,
            "learned": self.is_learned,
        }
        return tuple(term for term, is_set in terms.items() if is_set)

    @cached_property
    def _row(self) -> Any:
        """What compiled code reads of it (``midi.tables``), as the only row."""
        points = self.curve.points if isinstance(self.curve, Breakpoints) else ()
        lo, hi = self.ends
        return SimpleNamespace(
            invert=[float(self.invert)],
            curve=[CURVES.get(self.curve, POINTS)],
            lo=[lo],
            hi=[hi],
            first_point=[0],
            points=[len(points)],
            x=[x for x, _ in points],
            y=[y for _, y in points],
        )

    def from_unit(self, position: float) -> float:
        """Map the source's position, 0 to 1, to the target's value."""
        return float(uncompiled(curves.from_unit)(self._row, 0, position))

    def to_unit(self, value: float) -> float:
        """Find the position, 0 to 1, that `from_unit` maps to a value, clamped to the span."""
        return float(uncompiled(curves.to_unit)(self._row, 0, value))

    def semitones(self, position: float, bend_range: float) -> float:
        """Map the position of a pitch wheel to semitones, for a bend range in semitones."""
        return (2.0 * replace(self, span=(0.0, 1.0)).from_unit(position) - 1.0) * bend_range


def override_key(bind: Bind) -> tuple[str, tuple[int, ...]]:
    """Controller and channels of a bind; a file's binds replace those of its base of equal key."""
    return sources.controller(bind.source), bind.channels
