"""The delay of messages, which keeps their rhythm."""

from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.playing.delay import HELD_WINDOWS, Delay

RATE, BLOCK = 48000, 128
HANDLING = 48  # frames


class Device:
    """An instrument with the telemetry of a device that the test sets."""

    def __init__(self, fixed_ms: float | None = None) -> None:
        self._instrument = Instrument(InstrumentSpec(RATE))
        self.delay = Delay(self._instrument, BLOCK, fixed_ms)

    def window(self, ahead: float, longest: int | None = None) -> int:
        """Let a window pass; return the delay after it."""
        told = self._instrument._rig["published"]
        told["ahead_window"] += 1
        told["ahead"], told["longest"] = ahead, round(ahead) if longest is None else longest
        for _ in range(2):
            self.delay.update()
        return self.delay.frames


def test_what_two_windows_in_a_row_tell_is_waited_for():
    """At first a block and a millisecond."""
    for period in (256, 1024, 8192):
        device = Device()
        assert (device.delay.period, device.delay.frames) == (BLOCK, BLOCK + HANDLING)
        assert device.window(period) == BLOCK + HANDLING
        assert device.window(period) == period + HANDLING
        assert device.delay.period == period


def test_a_device_that_asks_for_less_is_believed_after_a_while():
    device = Device()
    for _ in range(2):
        device.window(1024)
    waits = [device.window(256) for _ in range(HELD_WINDOWS + 1)]
    assert device.delay.period == 256
    assert waits[: HELD_WINDOWS - 1] == [1024 + HANDLING] * (HELD_WINDOWS - 1)
    assert waits[-1] == 256 + HANDLING


def test_what_a_player_asked_for_stays_whatever_the_device_does():
    for fixed_ms in (0.0, 5.0, 100.0):
        device = Device(fixed_ms)
        for ahead in (128, 1024, 1024, 1024):
            assert device.window(ahead) == round(48 * fixed_ms)
        assert device.delay.period == 1024  # is told all the same
