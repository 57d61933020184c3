"""The right hand: the bow, from stroke to stroke, or a finger that plucks."""

from __future__ import annotations

from collections.abc import Callable

from yehu_server.params.table import find
from yehu_server.playing.bowing import ORDINARY, manner
from yehu_server.playing.ownership import Ownership

CROSSING_MS = 20.0  # from one string to the other
SLURRED_MS = 25.0  # in which bow speed changes from a slurred note to the next
# Bow speed at no dynamics, as a share of that at full. By ear.
SOFTEST = 0.45
LEAST_DYNAMICS = 0.012  # below it, and thus at the first two steps of a controller, no bow
# A string is pulled aside so hard for medium pressure. By ear.
PULL_N, MEDIUM = 1.2, 0.4
HARDEST_PULL_N = find("/pluck/force").hi


class RightHand:
    """How the strings are set in motion.

    Parameters
    ----------
    wish : callable
        The present value of a parameter under ``/playing``.

    Attributes
    ----------
    hurry, weight : float
        What the sounding note has of bow speed and pressure, as factors of what is wished.
    """

    def __init__(self, own: Ownership, wish: Callable[[str], float]) -> None:
        self._own = own
        self._wish = wish
        self._direction = -1.0  # so that the first stroke is a down-bow, v_b > 0
        self._side = 0.0  # where the bow is; 0 where it is lifted
        self._bowing = ORDINARY  # how the sounding pitch is bowed
        self.hurry = self.weight = 1.0

    @property
    def wished_speed(self) -> float:
        """Bow speed (m/s) that the player wants."""
        share = SOFTEST + (1.0 - SOFTEST) * self._wish("/playing/dynamics")
        return self._wish("/playing/speed") * share * self.hurry

    def speed_at(self, pitch: float) -> float:
        """Bow speed (m/s) for a pitch: as wished, as far as the note bears it."""
        return min(self.wished_speed, manner(pitch).top_speed)

    def bows_alike(self, pitch: float) -> bool:
        """Whether a pitch is bowed as the one before."""
        return manner(pitch) == self._bowing

    def turn(self) -> None:
        """Let the next stroke go the other way, or the way that is wished for."""
        wish = round(self._wish("/playing/direction"))
        self._direction = float(wish or -self._direction)

    def lean(self, pitch: float | None, frame: int | None) -> None:
        """Lean on the bow, and place it, as wished and as the pitch (None: none) wants it."""
        pressure = self._wish("/playing/pressure") * self.weight
        if pitch is not None:
            self._bowing = manner(pitch)
            pressure = self._bowing.pressure(pressure, pitch)
        self._own.move("/bow/pressure", pressure, frame)
        beta = self._wish("/playing/bow_position") * self._bowing.farther
        self._own.move("/bow/position", beta, frame)

    def draw(
        self, pitch: float, side: float, frame: int | None, ramp_ms: float | None = None
    ) -> None:
        """Draw the bow over the string of a side; it gets to its speed in `ramp_ms`.

        Where it was lifted it attacks; where there are no dynamics it is lifted.
        """
        if self._wish("/playing/dynamics") < LEAST_DYNAMICS:
            if self._side != 0.0:
                self.lift(self._wish("/playing/release"), frame)
            return
        attack_ms = self._wish("/playing/attack")
        crossing_ms = CROSSING_MS
        if self._side == 0.0:
            ramp_ms, crossing_ms = attack_ms, attack_ms / 4.0
        self._side = side
        self._own.move("/bow/side", side, frame, crossing_ms)
        self._own.move("/bow/tremolo", self._wish("/playing/tremolo"), frame)
        self._own.move("/bow/speed", self._direction * self.speed_at(pitch), frame, ramp_ms)

    def lift(self, release_ms: float, frame: int | None) -> None:
        """End the stroke."""
        self._side = 0.0
        self._own.move("/bow/speed", 0.0, frame, release_ms)
        self._own.move("/bow/side", 0.0, frame, release_ms)

    def pluck(self, side: float, frame: int | None) -> None:
        """Pull the string of a side aside and let it go; lift the bow for it."""
        if self._side != 0.0:
            self.lift(CROSSING_MS, frame)
        force = PULL_N * self._wish("/playing/pressure") * self.weight / MEDIUM
        self._own.move("/pluck/force", side * min(force, HARDEST_PULL_N), frame)
        self._own.forget("/pluck/force")  # the next one may be as hard
