"""The right hand: draws the bow, or plucks."""

from __future__ import annotations

from collections.abc import Callable

from yehu_server.params.table import find
from yehu_server.playing.bowing import ORDINARY, manner
from yehu_server.playing.ownership import Ownership

CROSSING_MS = 20.0  # time to change from one string to the other
SLURRED_MS = 25.0  # ramp of bow speed from one slurred note to the next
# Bow speed at dynamics 0, as a fraction of that at full dynamics. By ear.
SOFTEST = 0.45
LEAST_DYNAMICS = 0.012  # below, at the first two steps of a controller, the bow is lifted
# Force of a pluck at medium pressure. By ear.
PULL_N, MEDIUM = 1.2, 0.4
HARDEST_PULL_N = find("/pluck/force").hi


class RightHand:
    """Moves the bow, and keeps the direction of its stroke.

    Parameters
    ----------
    wish : callable
        Returns the present value of a parameter under ``/playing``.

    Attributes
    ----------
    hurry, weight : float
        Random factors of the sounding note on bow speed and pressure.
    """

    def __init__(self, own: Ownership, wish: Callable[[str], float]) -> None:
        self._own = own
        self._wish = wish
        self._direction = -1.0  # so that the first stroke is a down-bow, v_b > 0
        self._side = 0.0  # /bow/side; 0 where the bow is lifted
        self._bowing = ORDINARY  # how the sounding pitch is bowed
        self.hurry = self.weight = 1.0

    @property
    def wished_speed(self) -> float:
        """Bow speed (m/s) that the player wishes for."""
        share = SOFTEST + (1.0 - SOFTEST) * self._wish("/playing/dynamics")
        return self._wish("/playing/speed") * share * self.hurry

    def speed_at(self, pitch: float) -> float:
        """Bow speed (m/s) for a pitch: as wished, up to the highest at which it speaks."""
        return min(self.wished_speed, manner(pitch).top_speed)

    def bows_alike(self, pitch: float) -> bool:
        """Whether a pitch is bowed as the present one is."""
        return manner(pitch) == self._bowing

    def turn(self) -> None:
        """Turn the direction of the stroke, or take the one wished for."""
        wish = round(self._wish("/playing/direction"))
        self._direction = float(wish or -self._direction)

    def lean(self, pitch: float | None, frame: int | None) -> None:
        """Set bow pressure and position, as wished and adapted to the pitch, if any."""
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
        """Draw the bow on the string of a side; its speed changes in `ramp_ms`.

        A lifted bow attacks in ``/playing/attack`` instead. Below LEAST_DYNAMICS the bow is
        lifted.
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
        """End the stroke in a time (ms)."""
        self._side = 0.0
        self._own.move("/bow/speed", 0.0, frame, release_ms)
        self._own.move("/bow/side", 0.0, frame, release_ms)

    def pluck(self, side: float, frame: int | None) -> None:
        """Pluck the string of a side; lift the bow before."""
        if self._side != 0.0:
            self.lift(CROSSING_MS, frame)
        force = PULL_N * self._wish("/playing/pressure") * self.weight / MEDIUM
        self._own.move("/pluck/force", side * min(force, HARDEST_PULL_N), frame)
        self._own.forget("/pluck/force")  # the next one may be as hard
