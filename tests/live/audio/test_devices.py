"""How an audio output is chosen by its name."""

from __future__ import annotations

import pytest

from yehu_server.errors import DeviceError
from yehu_server.live.audio.devices import AudioDevice, choose


def device(index: int, name: str, host_api: str, *, is_default: bool = False) -> AudioDevice:
    return AudioDevice(index, name, host_api, 2, 48000.0, 5.0, is_default)


DEVICES = [
    device(0, "HiFiBerry DAC: hifi (hw:1,0)", "ALSA"),
    device(3, "HDMI 0", "ALSA"),
    device(4, "HDMI 1", "ALSA"),
    device(7, "system", "JACK Audio Connection Kit", is_default=True),
    device(8, "HDMI", "OSS"),
]


def test_a_device_is_found_by_its_name_or_words_of_it():
    for wanted, index in [
        (None, 7),  # the system's default
        ("system", 7),
        ("system, JACK Audio Connection Kit", 7),
        ("jack", 7),
        ("hifi", 0),
        ("HIFI, alsa", 0),
        ("HDMI 1", 4),
        ("hdmi 0 alsa", 3),
        ("HDMI", 8),  # its whole name, though others have the word
        ("hdmi oss", 8),
    ]:
        assert choose(DEVICES, wanted).index == index, wanted


def test_words_that_fit_none_or_several_are_refused_with_the_names_that_there_are():
    for there, wanted, said in [
        (DEVICES, "hdmi alsa", r"several .* HDMI 0, ALSA; HDMI 1, ALSA"),
        (DEVICES, "usb", r"no audio output matches 'usb' .*HiFiBerry.*system"),
        ([], None, "there is no audio output"),
        ([], "hifi", "there are: none"),
    ]:
        with pytest.raises(DeviceError, match=said):
            choose(there, wanted)
