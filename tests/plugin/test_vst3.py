"""The VST3 plug-in in hosts that others wrote: pedalboard and dawdreamer, both of JUCE."""

import mido
import numpy as np
import pytest
from plugin.sounds import FRAMES, PHRASE, by_library, frequency, level_db

pytestmark = pytest.mark.slow
# These hosts move controllers to the beginning of a block, so that they come there.
BLOCK = 512
ALIGNED = [(frame // BLOCK * BLOCK if kind not in (0x80, 0x90) else frame, kind, *data)
           for frame, kind, *data in PHRASE]  # fmt: skip
RATES = (22050, 32000, 44100, 88200, 96000, 192000)


@pytest.fixture
def plugin(built):
    """The plug-in in pedalboard."""
    pedalboard = pytest.importorskip("pedalboard", reason="there is no pedalboard")
    return pedalboard.load_plugin(str(built / "Yehu.vst3"))


def played(plugin, messages=ALIGNED, rate=48000, block=BLOCK, frames=FRAMES):
    """What pedalboard plays of messages [shape=(frames, 2)]; frames are of 48 kHz."""
    listed = [
        mido.Message.from_bytes(bytes(message)).copy(time=(frame + 0.01) / 48000)
        for frame, *message in messages
    ]
    return plugin.process(listed, frames / 48000, rate, 2, block, True).T


def test_it_plays_the_samples_of_the_library(plugin, library):
    assert np.array_equal(played(plugin), by_library(library, ALIGNED, FRAMES))


@pytest.mark.parametrize("rate", RATES)
def test_pitch_and_level_are_the_same_at_any_rate(plugin, rate):
    usual, other = (played(plugin, rate=r)[int(0.25 * r) : int(0.54 * r)] for r in (48000, rate))
    pitch = frequency(usual, 48000)
    assert 1200.0 * abs(np.log2(frequency(other, rate) / pitch)) < 3.0
    assert abs(level_db(other) - level_db(usual)) < 1.0


def raw(plugin, name):
    """A parameter by its name, from 0 to 1; pedalboard's own attributes round."""
    return next(each for each in plugin._parameters if each.name == name)


def test_parameters_presets_and_state_open_in_a_new_instance(plugin, built, shown):
    import pedalboard

    wanted = {"Output gain": 0.25, "Preset": 1.0, "Mapping": 1.0}
    for name, unit in wanted.items():
        raw(plugin, name).raw_value = unit
    quiet = played(plugin)
    assert level_db(quiet) < -45.0
    other = pedalboard.load_plugin(str(built / "Yehu.vst3"))
    assert raw(other, "Preset").string_value == "none"
    other.raw_state = plugin.raw_state
    for name, unit in wanted.items():
        assert raw(other, name).raw_value == pytest.approx(unit)
    assert raw(other, "Room size").string_value == "25 m"  # by the preset, which is a hall
    assert raw(other, "Mapping").string_value == shown["/mapping"].choices[-1]
    assert level_db(played(other)) == pytest.approx(level_db(quiet), abs=0.5)
