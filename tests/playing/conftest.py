"""A player whose hands are watched, on an ideal instrument, and a keyboard to play on."""

import mido
import pytest
from hands import Checked, Watched, ideal

from yehu_server.params.spec import Curve
from yehu_server.playing.mapping import Bind, Mapping
from yehu_server.playing.player import Player


class Midi:
    """A keyboard: methods send messages, by default on channel 1 of the first port."""

    def __init__(self, player: Player) -> None:
        self.player = player

    def send(self, kind: str, channel: int = 1, port: int = 0, **fields: int) -> None:
        self.player.receive(mido.Message(kind, channel=channel - 1, **fields), port=port)

    def on(self, note: int, velocity: int = 64, channel: int = 1, port: int = 0) -> None:
        self.send("note_on", channel, port, note=note, velocity=velocity)

    def off(self, note: int, channel: int = 1, port: int = 0) -> None:
        self.send("note_off", channel, port, note=note)

    def cc(self, control: int, value: int, channel: int = 1, port: int = 0) -> None:
        self.send("control_change", channel, port, control=control, value=value)

    def bend(self, pitch: int, channel: int = 1, port: int = 0) -> None:
        self.send("pitchwheel", channel, port, pitch=pitch)

    def touch(self, value: int, channel: int = 1, port: int = 0) -> None:
        self.send("aftertouch", channel, port, value=value)

    def rpn(
        self, msb: int, lsb: int, *data: tuple[int, int], channel: int = 1, port: int = 0
    ) -> None:
        for control, value in ((101, msb), (100, lsb), *data):
            self.cc(control, value, channel, port)


@pytest.fixture
def listener() -> Watched:
    return Watched(calibration=ideal())


@pytest.fixture
def player(listener) -> Checked:
    """A player without random variation."""
    commands = Checked(listener)
    commands.write("/playing/variation", 0.0)
    return commands


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
        Bind("cc 10", "/room/pan"),
        Bind("cc 11", "/playing/expression"),
    )
    return Mapping("test", binds)


@pytest.fixture
def midi(player, mapping) -> Midi:
    return Midi(player.mapped(mapping))


@pytest.fixture
def make(player):
    """A keyboard with a mapping of its own."""
    return lambda *binds, **more: Midi(player.mapped(Mapping("test", binds, **more)))
