"""``yehu.play``: a player in a notebook, else the sound device."""

import base64
import io
import re
import sys
from unittest.mock import ANY, Mock

import numpy as np
import pytest
import soundfile

import yehu_server as yehu
from yehu_server.api import playback

RATE = 8000


@pytest.fixture
def device(monkeypatch) -> Mock:
    """A sound device that keeps what it is to play."""
    module = Mock(PortAudioError=OSError)
    monkeypatch.setattr(playback, "load_portaudio", lambda: module)
    return module.play


def of_page(player) -> tuple[np.ndarray, int]:
    """The sound in a player's page."""
    page = player._repr_html_()
    data = re.fullmatch(r'<audio controls src="data:audio/wav;base64,([\w+/=]+)"></audio>', page)
    return soundfile.read(io.BytesIO(base64.b64decode(data[1])))


def test_outside_a_notebook_it_plays_to_the_end(device):
    sound = np.array([0.0, 0.5, -0.25], np.float32)
    assert yehu.play(sound, RATE) is None
    device.assert_called_once_with(ANY, RATE, blocking=True)
    np.testing.assert_array_equal(device.call_args.args[0], sound)


def test_in_a_notebook_it_is_a_player_that_holds_the_sound(device, monkeypatch):
    shell = type("ZMQInteractiveShell", (), {})()
    monkeypatch.setitem(sys.modules, "IPython", Mock(get_ipython=lambda: shell))
    sound = 0.5 * np.sin(np.arange(400.0))
    found, rate = of_page(yehu.play(np.stack([sound, -sound], axis=1), RATE))
    assert rate == RATE
    np.testing.assert_allclose(found, np.stack([sound, -sound], axis=1), atol=2.0**-15)
    # What is too loud is clipped and does not wrap around.
    found, _ = of_page(yehu.play(np.array([0.0, 2.0, -3.0]), RATE))
    np.testing.assert_allclose(found, [0.0, 1.0, -1.0], atol=1e-4)
    device.assert_not_called()


def test_without_a_device_or_a_sound_one_line_says_so(device, refused):
    for names, sound, rate in (
        ("sound", "a.wav", None),
        ("sound", None, RATE),
        ("sound", np.zeros((2, 2, 2)), RATE),
        ("sample_rate", np.zeros(5), None),
        ("sample_rate", np.zeros(5), -1.0),
        ("integers", np.zeros(5, np.int16), RATE),
        ("sound", [[1.0], [1.0, 2.0]], RATE),
    ):
        refused(names, yehu.play, sound, rate)
    device.assert_not_called()
    device.side_effect = OSError("Error querying device -1")
    refused("no sound device", yehu.play, np.zeros(10), RATE)
