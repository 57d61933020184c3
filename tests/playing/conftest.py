"""An instrument that only records its events, a simple neck, and a keyboard to play on."""

from __future__ import annotations

import math
from typing import NamedTuple

import mido
import pytest

from yehu_server.params.spec import Curve, Place
from yehu_server.params.table import TABLE
from yehu_server.playing.mapping import Bind, Mapping
from yehu_server.playing.messages import MidiPlayer
from yehu_server.playing.performer import Performer

ENGINE = {param.address for param in TABLE if param.place is Place.ENGINE}
FINGERS = (1, 2, 3, 4)


class Move(NamedTuple):
    """One call of an instrument's `write`."""

    address: str
    value: float
    frame: int | None
    ramp_ms: float | None


class Listener:
    """Stands in for the instrument; records the events it gets."""

    def __init__(self) -> None:
        self.moves: list[Move] = []
        self.silenced: list[int | None] = []

    def write(
        self, address: str, value: float, *, frame: int | None = None, ramp_ms: float | None = None
    ) -> float:
        assert address in ENGINE
        assert math.isfinite(value)
        self.moves.append(Move(address, value, frame, ramp_ms))
        return value

    def silence(self, *, frame: int | None = None) -> None:
        self.silenced.append(frame)

    def of(self, address: str) -> list[Move]:
        return [move for move in self.moves if move.address == address]

    def __getitem__(self, address: str) -> float:
        """The last target of a parameter."""
        return self.of(address)[-1].value

    def where(self) -> tuple[str, float | None]:
        """The bowed string, and the semitones above it of the finger that stops it, if any."""
        string = {1.0: "F", -1.0: "C", 0.0: "none"}[self["/bow/side"]]
        if self.press == 0.0:
            return string, None
        return string, round(self.place * 100.0, 6)

    @property
    def finger(self) -> int | None:
        """The finger that is down."""
        down = [
            number
            for number in FINGERS
            if (moves := self.of(f"/finger/{number}/press")) and moves[-1].value > 0.0
        ]
        assert len(down) <= 1
        return down[0] if down else None

    @property
    def press(self) -> float:
        """Press of the finger that is down (N)."""
        return 0.0 if self.finger is None else self[f"/finger/{self.finger}/press"]

    @property
    def place(self) -> float:
        """Place of the finger that is down (m)."""
        return self[f"/finger/{self.finger}/position"]


class Ruler:
    """A neck with one centimetre per semitone on both strings."""

    OPEN = (65.0, 72.0)

    def position(self, string: int, pitch: float, speed: float = 0.2) -> float:
        assert 0.0 < speed < 2.0
        return 0.01 * (pitch - self.OPEN[string])

    def balance_db(self, string: int, pitch: float, speed: float) -> float:
        """C5 and above are 6 dB too loud."""
        assert string in (0, 1)
        assert 0.0 < speed < 2.0
        return -6.0 if pitch >= 72.0 else 0.0


class Midi:
    """A keyboard: methods send messages, by default on channel 1."""

    def __init__(self, player: MidiPlayer) -> None:
        self._player = player

    def send(self, kind: str, **fields) -> None:
        self._player.receive(mido.Message(kind, **fields))

    def on(self, note: int, velocity: int = 64, channel: int = 1) -> None:
        self.send("note_on", note=note, velocity=velocity, channel=channel - 1)

    def off(self, note: int, channel: int = 1) -> None:
        self.send("note_off", note=note, channel=channel - 1)

    def cc(self, control: int, value: int, channel: int = 1) -> None:
        self.send("control_change", control=control, value=value, channel=channel - 1)

    def bend(self, pitch: int, channel: int = 1) -> None:
        self.send("pitchwheel", pitch=pitch, channel=channel - 1)

    def touch(self, value: int, channel: int = 1) -> None:
        self.send("aftertouch", value=value, channel=channel - 1)

    def rpn(self, msb: int, lsb: int, *data: tuple[int, int], channel: int = 1) -> None:
        for control, value in ((101, msb), (100, lsb), *data):
            self.cc(control, value, channel)


@pytest.fixture
def listener_type() -> type[Listener]:
    """The class, for tests that need several."""
    return Listener


@pytest.fixture
def listener() -> Listener:
    return Listener()


@pytest.fixture
def ruler() -> Ruler:
    return Ruler()


@pytest.fixture
def player(listener, ruler) -> Performer:
    """A player without random variation."""
    performer = Performer(listener, ruler)
    performer.write("/playing/variation", 0.0)
    return performer


@pytest.fixture
def mapping() -> Mapping:
    """The roles of the shipped keyboard mapping, with figures of our own."""
    binds = (
        Bind("bend", "/playing/bend"),
        Bind("pressure", "/playing/press", (1.5, 5.0)),
        Bind("poly-pressure", "/playing/press", (1.5, 5.0)),
        Bind("cc 1", "/playing/speed", (0.08, 0.35), Curve.EXP),
        Bind("velocity", "/playing/pressure", (0.3, 0.55)),
        Bind("cc 7", "/playing/volume"),
        Bind("cc 11", "/playing/expression"),
    )
    return Mapping("test", binds)


@pytest.fixture
def midi(player, mapping) -> Midi:
    return Midi(MidiPlayer(player, mapping))
