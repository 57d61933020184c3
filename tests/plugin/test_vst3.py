"""The VST3 plug-in in hosts of others, all of JUCE: pedalboard, dawdreamer and pluginval."""

import os
import shutil
import subprocess

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


def choose(plugin, preset):
    choices = plugin.parameters["preset"].valid_values
    raw(plugin, "Preset").raw_value = choices.index(preset) / (len(choices) - 1)


def test_a_preset_reaches_the_host_and_is_not_undone_by_it(plugin):
    assert raw(plugin, "Preset").string_value == "vibrato"
    bowed = level_db(played(plugin)[20000:28000])
    choose(plugin, "pizzicato")
    assert raw(plugin, "Pizzicato").raw_value == 1.0
    for _ in range(2):  # before each it sends all that it has
        assert level_db(played(plugin)[20000:28000]) < bowed - 15.0  # it has died away
    raw(plugin, "Pizzicato").raw_value = 0.0
    assert raw(plugin, "Preset").string_value == "pizzicato, changed"
    assert level_db(played(plugin)[20000:28000]) > bowed - 3.0
    assert raw(plugin, "Preset").raw_value == 0.0
    choose(plugin, "pizzicato")
    assert raw(plugin, "Pizzicato").raw_value == 1.0


def test_a_host_with_a_table_of_its_own_does_not_undo_a_preset(built, shown):
    daw = pytest.importorskip("dawdreamer", reason="there is no dawdreamer")
    engine = daw.RenderEngine(48000, BLOCK)
    plugin = engine.make_plugin_processor("yehu", str(built / "Yehu.vst3"))
    engine.load_graph([(plugin, [])])
    plugin.add_midi_note(69, 96, 0.0, 0.6)
    numbers = {each["name"]: each["index"] for each in plugin.get_parameters_description()}

    def level():
        engine.render(0.7)
        return level_db(engine.get_audio().T[20000:28000])

    bowed = level()
    choices = shown["/preset"].choices
    plugin.set_parameter(numbers["Preset"], choices.index("pizzicato") / (len(choices) - 1))
    for _ in range(3):
        assert level() < bowed - 20.0
        assert plugin.get_parameter_text(numbers["Pizzicato"]) == "on"
        assert plugin.get_parameter_text(numbers["Preset"]) == "pizzicato"
    plugin.set_parameter(numbers["Pizzicato"], 1.0)
    assert level() < bowed - 20.0
    plugin.set_parameter(numbers["Pizzicato"], 0.0)
    assert level() > bowed - 3.0
    assert plugin.get_parameter_text(numbers["Preset"]) == "pizzicato, changed"


def test_parameters_presets_and_state_open_in_a_new_instance(plugin, built, shown):
    import pedalboard

    hall = shown["/room"].choices.index("hall") / shown["/room"].steps
    wanted = {"Output gain": 0.25, "Room": hall, "Mapping": 1.0}
    for name, unit in wanted.items():
        raw(plugin, name).raw_value = unit
    quiet = played(plugin)
    assert level_db(quiet) < -45.0
    other = pedalboard.load_plugin(str(built / "Yehu.vst3"))
    assert raw(other, "Preset").string_value == "vibrato"
    other.raw_state = plugin.raw_state
    for name, unit in wanted.items():
        assert raw(other, name).raw_value == pytest.approx(unit, abs=1e-6)
    assert raw(other, "Room size").string_value == "25 m"
    assert [raw(other, name).string_value for name in ("Preset", "Room")] == ["vibrato", "hall"]
    assert raw(other, "Mapping").string_value == shown["/mapping"].choices[-1]
    assert level_db(played(other)) == pytest.approx(level_db(quiet), abs=0.5)


def test_the_state_has_what_was_set_before_a_block_was_processed(plugin, built):
    import pedalboard

    choose(plugin, "flautando")
    raw(plugin, "Output gain").raw_value = 0.25
    other = pedalboard.load_plugin(str(built / "Yehu.vst3"))
    for state in plugin.raw_state, (played(plugin, frames=BLOCK), plugin.raw_state)[1]:
        other.raw_state = state
        assert raw(other, "Preset").string_value == "flautando"
        assert raw(other, "Output gain").raw_value == pytest.approx(0.25, abs=1e-6)
        assert raw(other, "Pressure").raw_value == raw(plugin, "Pressure").raw_value


@pytest.mark.skipif(shutil.which("pluginval") is None, reason="there is no pluginval")
def test_pluginval_at_its_strictest_finds_nothing(built, display, tmp_path):
    words = ["--validate", built / "Yehu.vst3", "--strictness-level", "10"]
    done = subprocess.run(
        [shutil.which("pluginval"), *words],
        env={**os.environ, "DISPLAY": display, "HOME": str(tmp_path)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout[-2000:]
