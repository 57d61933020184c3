"""No note hangs, whatever messages come in whatever order."""

import random
from collections.abc import Iterator

import mido
import pytest
from hands import Checked, Watched
from hypothesis import given, settings
from hypothesis import strategies as st

from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.playing.calibration_store import calibration_for
from yehu_server.playing.mapping import load
from yehu_server.playing.part_state import Key
from yehu_server.playing.tuning import RangePolicy

CHANNELS = (0, 1, 9)
ours = settings(max_examples=25)

channels, data = st.sampled_from(CHANNELS), st.integers(0, 127)
some_keys = st.integers(62, 92) | st.sampled_from([70, 71, 72, 73])
some_controls = [1, 6, 7, 11, 20, 38, 64, 96, 97, 98, 99, 100, 101, *range(120, 128)]


def messages(kind: str, **fields: st.SearchStrategy[int]) -> st.SearchStrategy[mido.Message]:
    return st.builds(mido.Message, st.just(kind), channel=channels, **fields)


on = messages("note_on", note=some_keys, velocity=data)
off = messages("note_off", note=some_keys)
pedal = messages("control_change", control=st.just(64), value=st.sampled_from([0, 127]))
control = messages("control_change", control=st.sampled_from(some_controls), value=data)
wheel = messages("pitchwheel", pitch=st.integers(-8192, 8191))
pressure = messages("aftertouch", value=data)
poly = messages("polytouch", note=some_keys, value=data)
program = messages("program_change", program=st.just(3))
anything = st.one_of(on, on, off, off, pedal, control, wheel, pressure, poly, program)


def calibrated(seed: int = 0) -> Watched:
    """Hands on the instrument that is played."""
    calibration = calibration_for(44100.0)
    return Watched(quantities=calibration.tuned(Quantities()), calibration=calibration, seed=seed)


def let_everything_go():
    for channel in CHANNELS:
        for note in range(60, 95):
            yield mido.Message("note_off", channel=channel, note=note)
        yield mido.Message("control_change", channel=channel, control=64, value=0)


@pytest.mark.parametrize("policy", RangePolicy)
def test_no_note_sticks_once_all_keys_and_pedals_are_up(policy):
    @ours
    @given(st.lists(anything, max_size=60), st.integers(0, 3))
    def holds(stream, seed):
        listener = calibrated(seed)
        player = Checked(listener, policy)
        player.write("/playing/variation", 1.0)
        midi = player.mapped(load("keyboard"))
        listener.write("/bow/speed", 0.0)
        listener.write("/bow/side", 0.0)
        for message in stream:
            midi.receive(message)
            sounds = player.sounding is not None
            assert (listener["/bow/side"] != 0.0) == sounds
            assert (listener["/bow/speed"] != 0.0) == sounds
        for message in let_everything_go():
            midi.receive(message)
        assert player.sounding is None
        assert listener["/bow/speed"] == 0.0
        assert listener["/bow/side"] == 0.0

    holds()


def few_keys(seed: int) -> list[mido.Message]:
    chance = random.Random(seed)
    messages = []
    for _ in range(80):
        channel = chance.choice([0, 0, 1, 9])
        if chance.random() < 0.2:
            value = chance.choice([0, 127])
            message = mido.Message("control_change", channel=channel, control=64, value=value)
        else:
            kind = chance.choice(["note_on", "note_off"])
            velocity = chance.choice([0, 64, 64])
            note = chance.choice([66, 73, 80])
            message = mido.Message(kind, channel=channel, note=note, velocity=velocity)
        messages.append(message)
    return messages


BOX = 2  # a port without keys


class Keyboards:
    """An independent model of what sounds: the last key struck among those held.

    The pedals of a box hold the notes of all keyboards.
    """

    def __init__(self) -> None:
        self.order: list[Key] = []
        self.down: set[Key] = set()
        self.pedals: set[int] = set()

    def hear(self, port: int, message: mido.Message | None) -> None:
        if message is None:  # it is gone
            self.down = {key for key in self.down if key.channel // 16 != port}
            self.pedals = {channel for channel in self.pedals if channel // 16 != port}
            self.order = [key for key in self.order if key.channel // 16 != port]
        elif message.channel == 9:
            return
        elif message.type == "control_change":
            channel = 16 * port + message.channel
            {0: self.pedals.discard, 127: self.pedals.add}[message.value](channel)
        else:
            key = Key(16 * port + message.channel, message.note)
            self.down.discard(key)
            if message.type == "note_on" and message.velocity > 0:
                self.down.add(key)
                self.order = [*(other for other in self.order if other != key), key]
        self.order = [key for key in self.order if self.is_held(key)]

    def is_held(self, key: Key) -> bool:
        box = any(channel // 16 == BOX for channel in self.pedals)
        return key in self.down or key.channel in self.pedals or box

    @property
    def sounding(self) -> Key | None:
        return self.order[-1] if self.order else None


def boxes(seed: int) -> Iterator[tuple[int, mido.Message | None]]:
    """Two keyboards, a pedal box, and ports that disappear (None) and come back."""
    chance = random.Random(seed)
    for port in (0, 1):
        for velocity in (64, 0):
            yield port, mido.Message("note_on", note=70, velocity=velocity)
    for message in few_keys(seed):
        port = chance.randrange(3)
        if chance.random() < 0.05:
            yield port, None
        elif port != BOX or message.type == "control_change":
            yield port, message


def test_the_last_key_struck_of_those_hand_or_pedal_hold_is_the_one_that_sounds(everything):
    for seed in range(60 if everything else 20):
        player = Checked(calibrated())
        midi = player.mapped(load("keyboard"))
        expected = Keyboards()
        for number, (port, message) in enumerate(boxes(seed)):
            if message is None:
                midi.end_port_notes(port)
            else:
                midi.receive(message, port=port)
            expected.hear(port, message)
            assert player.sounding == expected.sounding, (seed, number, port, message)
