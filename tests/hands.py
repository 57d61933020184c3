"""An instrument whose player acts at once, and what its hands do."""

import math
from typing import Any, NamedTuple

import numpy as np

from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.core.midi.interpret_events import interpret
from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.core.player.commands import apply
from yehu_server.core.player.note_tables import OPEN_NOTES, PITCHES, SPEEDS, NoteTables
from yehu_server.core.player.notes import sounding_pitch
from yehu_server.core.player.parameter_indices import INDEX
from yehu_server.core.player.record import SILENT
from yehu_server.params.table import ENGINE, FINGERS, SLOT, find
from yehu_server.playing.part_state import Key
from yehu_server.playing.player import Player

RATE = 48000.0  # whole milliseconds are whole frames
# What the player's moves are computed from.
DECIDED = (
    "value",
    "finger_pitch",
    "position",
    "bowing",
    "balance",
    "speed_variation",
    "pressure_variation",
    "detuned",
)
# Balance (dB) of notes below C5, and of those from C5 up, which are 6 dB louder.
LOW_DB, HIGH_DB = 6.0 * 25.0 / 38.0, -6.0 * 13.0 / 38.0


def ideal(a4: float = 440.0) -> NoteTables:
    """Fingers stop where an ideal string is in tune; from C5 up all is 6 dB louder."""
    strings = Quantities().strings
    return NoteTables(
        a4,
        (strings[0].T, strings[1].T),
        tuple(tuple((0.0,) * len(SPEEDS) for _ in pitches) for pitches in PITCHES),
        tuple(
            tuple((6.0 if pitch >= 72.0 else 0.0,) * len(SPEEDS) for pitch in (opened, *pitches))
            for opened, pitches in zip((65.0, 72.0), PITCHES, strict=True)
        ),
    )


class Move(NamedTuple):
    """A parameter of the engine that begins to move."""

    address: str
    value: float
    frame: int | None
    ramp_ms: float


class Watched(Instrument):
    """Acts on each event as it is posted, and keeps what moves; options are `Instrument`'s.

    Events that name no frame come a frame after each other. Whatever moves has arrived before the
    next command.
    """

    def __init__(self, **options: Any) -> None:
        super().__init__(InstrumentSpec(RATE, **options))
        self.moves: list[Move] = []
        self.silenced: list[int | None] = []
        self._player, self._controls = self._rig["player"], self._rig["controls"]
        self._count = 0

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
        self._count += 1
        at = self._count if frame is None else frame
        m, places = self.midi, (self._rig["midi"].ctypes.data, self._rig["tables"].ctypes.data)
        interpret.call(*places, at, kind, index, value, other)
        for n in range(int(m["commands"])):
            command = (m[f"out_{what}"][n].item() for what in ("kind", "index", "value", "other"))
            self._apply(frame, at, *command)
        return True

    def wait(self, seconds: float) -> None:
        """Let time go by before what is posted next."""
        self._controls["frame"] += round(seconds * RATE)

    def _apply(
        self, frame: int | None, at: int, kind: int, index: int, value: float, other: float
    ) -> None:
        c = self._controls[0]
        c["remaining"] = -1  # of what is not moved
        before = c["value"].copy()
        addresses = self._player.ctypes.data, self._controls.ctypes.data
        apply.call(*addresses, at, kind, index, value, other)
        for slot in np.flatnonzero(c["remaining"] >= 0):
            address, ramp_ms = ENGINE[slot].address, 1e3 * float(c["remaining"][slot]) / RATE
            if ramp_ms > 0.0 and c["value"][slot] != before[slot]:  # it jumps, and then moves on
                self.moves.append(Move(address, float(c["value"][slot]), frame, 0.0))
            self.moves.append(Move(address, float(c["target"][slot]), frame, ramp_ms))
        c["value"] = c["target"]
        # The engine would ignore what is not a number.
        assert all(np.isfinite(self._player[name]).all() for name in DECIDED)
        if c["silence_in"] > 0:
            self.silenced.append(frame)
        c["silence_in"] = 0

    def meters(self) -> Any:
        """The meters, as if all that is posted had been applied."""
        meters = super().meters().copy()
        meters["drained"] = meters["next_frame"] = 1 << 62
        meters["pitch"] = sounding_pitch(self._player[0])
        return meters

    @property
    def held(self) -> list[Key]:
        """The keys that the player holds, in the order pressed."""
        p = self._player[0]
        keys = zip(p["held_channel"].tolist(), p["held_key"].tolist(), strict=True)
        return [Key(*key) for key in list(keys)[: p["held"]]]

    @property
    def sounding(self) -> Key | None:
        """The key that the player lets sound."""
        number = self._player[0]["sounding"]
        return None if number == SILENT else self.held[number]

    def requested(self, address: str) -> float:
        """The value that the player has for a parameter."""
        return float(self._player[0]["value"][INDEX[address]])

    def of(self, address: str) -> list[Move]:
        """The moves of a parameter."""
        return [move for move in self.moves if move.address == address]

    def __getitem__(self, address: str) -> float:
        """Where a parameter was moved to last."""
        return self.of(address)[-1].value

    @property
    def finger(self) -> int | None:
        """The finger that is down."""
        press = self._controls["target"][0]
        down = [number for number in FINGERS if press[SLOT[f"/finger/{number}/press"]] > 0.0]
        assert len(down) <= 1
        return down[0] if down else None

    @property
    def press(self) -> float:
        """Force of the finger that is down (N)."""
        return 0.0 if self.finger is None else self[f"/finger/{self.finger}/press"]

    @property
    def position(self) -> float:
        """Position of the finger that is down (m)."""
        return self[f"/finger/{self.finger}/position"]

    def where(self) -> tuple[str, float | None]:
        """The bowed string, and the semitones above it of the finger that stops it, if any.

        The semitones are those of an ideal string.
        """
        side = self["/bow/side"]
        string = {1.0: "F", -1.0: "C", 0.0: "none"}[side]
        if self.press == 0.0:
            return string, None
        number = 0 if side > 0.0 else 1
        return string, round(self.pitch_at(number, self.position) - OPEN_NOTES[number], 6)

    def pitch_at(self, string: int, position: float) -> float:
        """Pitch (fractional MIDI note) of an ideal string, 0 or 1, stopped at a position (m)."""
        silk = self.spec.quantities.strings[string]
        length = self.spec.quantities.bridge_x - position
        frequency = math.sqrt(silk.T / silk.rho_A) / (2.0 * length)
        return 69.0 + 12.0 * math.log2(frequency / 440.0)


class Checked(Player):
    """Commands to a `Watched`: what they tell must be what its player holds."""

    instrument: Watched

    @property
    def sounding(self) -> Key | None:
        told = super().sounding
        assert told == self.instrument.sounding
        return told

    def held(self, channel: int | None = None) -> list[Key]:
        assert super().held() == self.instrument.held
        return super().held(channel)

    def value(self, address: str) -> float:
        told = super().value(address)
        if not find(address).player_controlled:
            assert told == self.instrument.requested(address)
        return told
