"""An instrument that applies its commands and makes no sound, and a calibration for it."""

import heapq
import math

import numpy as np
from interpreted import ALL_KINDS, Leader, Requested

from yehu_server.core.controls.record import prepare_controls
from yehu_server.core.controls.slots import LOWER_BOUNDS, UPPER_BOUNDS
from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.core.player.commands import KINDS, apply
from yehu_server.core.player.notes import sounding_pitch
from yehu_server.core.player.record import prepare_player
from yehu_server.params.table import SLOT, TABLE
from yehu_server.playing.calibration_store import calibration_for
from yehu_server.playing.player import Player

CALIBRATION = calibration_for(Leader.rate)  # a shipped one
QUANTITIES = CALIBRATION.tuned(Quantities())
DEFAULTS = {param.address: param.default for param in TABLE}
RATE = Leader.rate
PLAYER = prepare_player(QUANTITIES, RATE, DEFAULTS, calibration=CALIBRATION)
CONTROLS = prepare_controls(QUANTITIES, RATE, DEFAULTS)
_ = apply.call, sounding_pitch(PLAYER[0])  # compile now, not within an input's bounds
# Of the player's record, what may not be a number: where nothing was sent or heard yet.
MAY_BE_NAN = {"sent", "first_error"}


class Instrument(Leader):
    """Stands in for ``engine.instrument.Instrument``; `now_s` is its time."""

    def __init__(self) -> None:
        super().__init__()
        self.now_s = 0.0
        self.posted = self.delay = 0
        self._player, self._controls = PLAYER.copy(), CONTROLS.copy()
        self._waiting: list[tuple[int, int, int, int, float, float]] = []

    @property
    def frame(self) -> int:
        return int(self.now_s * self.rate)

    def frame_at(self, _time_ns: int) -> float:
        return self.now_s * self.rate

    def post(
        self,
        kind: int,
        *,
        frame: int | None = None,
        index: int = 0,
        value: float = 0.0,
        other: float = 0.0,
        sender: int = 0,  # noqa: ARG002 - as Instrument.post
    ) -> bool:
        assert 0 <= kind < len(ALL_KINDS)
        assert isinstance(index, (int, np.integer))
        assert frame is None or isinstance(frame, int)
        assert math.isfinite(value), ALL_KINDS[kind]
        assert math.isfinite(other), ALL_KINDS[kind]
        at = self.frame if frame is None else frame
        heapq.heappush(self._waiting, (at, self.posted, kind, int(index), value, other))
        self.posted += 1
        return True

    def play(self) -> None:
        """Interpret and apply what is due, by frame and then as posted."""
        while self._waiting and self._waiting[0][0] <= self.frame:
            frame, _, *event = heapq.heappop(self._waiting)
            for command in self.interpret(frame, *event):
                self.apply(command)

    def interpret_events(self) -> None:
        self.play()

    def apply(self, command: Requested) -> None:
        """Apply a command at this frame; every parameter stays within its range."""
        kind, _, value, other = command
        assert 0 <= kind < len(KINDS)
        assert math.isfinite(value), command
        assert math.isfinite(other), command
        apply.call(self._player.ctypes.data, self._controls.ctypes.data, self.frame, *command)
        target = self._controls["target"][0]
        assert ((target >= LOWER_BOUNDS) & (target <= UPPER_BOUNDS)).all(), (
            command
        )  # also refuses NaN

    def check_player(self) -> None:
        """All that the player decides by is a number."""
        check_numbers(self._player)
        assert np.isfinite(self.midi["value"]).all()

    def meters(self) -> dict[str, float]:
        self.play()
        pitch = sounding_pitch(self._player[0])
        return {"pitch": pitch, "drained": self.posted, "next_frame": self.frame + 1}

    def target(self, address: str) -> float:
        self.play()
        return float(self._controls["target"][0, SLOT[address]])


def check_numbers(record: np.ndarray) -> None:
    """All numbers of a record are finite, in the records within it too."""
    for name in set(record.dtype.names or ()) - MAY_BE_NAN:
        if record.dtype[name].base.names:
            check_numbers(record[name])
        else:
            assert np.isfinite(record[name]).all(), name


def check_values(player: Player) -> None:
    """Every parameter is within its range."""
    values = player.values()
    for param in TABLE:
        assert param.lo <= values[param.address] <= param.hi, param.address


def check_silence(player: Player, instrument: Instrument) -> None:
    """After a panic and a second, no note sounds and the bow is lifted and at rest."""
    instrument.now_s += 1.0
    assert player.pitch is None
    assert not instrument._player["held"][0]
    assert not instrument.midi["held"]
    assert instrument.target("/bow/speed") == instrument.target("/bow/side") == 0.0
    instrument.check_player()
