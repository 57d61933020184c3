"""``yehu.play``: a player in a notebook, else the sound device."""

from __future__ import annotations

import base64
import io
import re
import types

import numpy as np
import pytest
import soundfile

import yehu_server as yehu
from yehu_server import YehuError
from yehu_server.api import playback

RATE = 8000


class PortAudioError(Exception):
    pass


@pytest.fixture
def device(monkeypatch) -> list:
    """A sound device that keeps what it is to play."""
    kept = []
    module = types.SimpleNamespace(
        PortAudioError=PortAudioError,
        play=lambda sound, rate, *, blocking: kept.append((sound, rate, blocking)),
    )
    monkeypatch.setattr(playback, "load_portaudio", lambda: module)
    return kept


@pytest.fixture
def notebook(monkeypatch) -> None:
    shell = type("ZMQInteractiveShell", (), {})()
    monkeypatch.setitem(
        __import__("sys").modules, "IPython", types.SimpleNamespace(get_ipython=lambda: shell)
    )


def of_page(player) -> tuple[np.ndarray, int]:
    """The sound in a player's page."""
    page = player._repr_html_()
    data = re.fullmatch(r'<audio controls src="data:audio/wav;base64,([\w+/=]+)"></audio>', page)
    return soundfile.read(io.BytesIO(base64.b64decode(data[1])))


def test_outside_a_notebook_it_plays_to_the_end(device):
    sound = np.array([0.0, 0.5, -0.25], np.float32)
    assert yehu.play(sound, RATE) is None
    ((played, rate, blocking),) = device
    np.testing.assert_array_equal(played, sound)
    assert (rate, blocking) == (RATE, True)


@pytest.mark.usefixtures("notebook")
def test_in_a_notebook_it_is_a_player_that_holds_the_sound(device):
    sound = 0.5 * np.sin(np.arange(400.0))
    player = yehu.play(np.stack([sound, -sound], axis=1), RATE)
    found, rate = of_page(player)
    assert rate == RATE
    np.testing.assert_allclose(found, np.stack([sound, -sound], axis=1), atol=2.0**-15)
    assert not device


@pytest.mark.usefixtures("notebook")
def test_what_is_too_loud_is_clipped_and_does_not_wrap_around():
    found, _ = of_page(yehu.play(np.array([0.0, 2.0, -3.0]), RATE))
    np.testing.assert_allclose(found, [0.0, 1.0, -1.0], atol=1e-4)


def test_a_result_brings_its_rate(device):
    tune = yehu.render([("A4", 0.0, 0.2)], sample_rate=48000, tail=0.0)
    yehu.play(tune)
    np.testing.assert_array_equal(device[0][0], tune.sound)
    assert device[0][1] == 48000


def test_pressure_is_scaled_to_be_heard(device):
    run = yehu.simulate({"duration": 0.05, "controls": {"bow_force": 0.7, "bow_velocity": 0.3}})
    yehu.play(run)
    assert np.abs(device[0][0]).max() == pytest.approx(10.0 ** (-1.0 / 20.0))


def test_a_rendering_shows_itself_as_a_player():
    tune = yehu.render([("A4", 0.0, 0.2)], tail=0.0)
    found, rate = of_page(tune)
    assert rate == 44100
    np.testing.assert_allclose(found, tune.sound, atol=2.0**-15)


def test_without_a_device_one_line_says_so(monkeypatch):
    def none(*_, **__):
        raise PortAudioError("Error querying device -1")

    module = types.SimpleNamespace(PortAudioError=PortAudioError, play=none)
    monkeypatch.setattr(playback, "load_portaudio", lambda: module)
    with pytest.raises(YehuError, match="no sound device"):
        yehu.play(np.zeros(10), RATE)


@pytest.mark.parametrize(
    ("sound", "rate", "names"),
    [
        ("a.wav", None, "sound"),
        (None, RATE, "sound"),
        (np.zeros((2, 2, 2)), RATE, "sound"),
        (np.zeros(5), None, "sample_rate"),
        (np.zeros(5), -1.0, "sample_rate"),
        (np.zeros(5, np.int16), RATE, "integers"),
        ([[1.0], [1.0, 2.0]], RATE, "sound"),
    ],
)
def test_what_is_no_sound_is_told(device, sound, rate, names):
    with pytest.raises(YehuError, match=names):
        yehu.play(sound, rate)
    assert not device
