"""In which order audio devices are listed, and how one is chosen by its name."""

from types import SimpleNamespace

import pytest

from yehu_server.errors import DeviceError
from yehu_server.live.audio.devices import INPUT, OUTPUT, AudioDevice, choose, devices

ALSA, OSS, JACK, PULSE = "ALSA", "OSS", "JACK Audio Connection Kit", "PulseAudio"

# What PortAudio lists, in its order; of each host API the last one is the default, as ALSA's is.
CARDS = (ALSA, "HiFiBerry DAC: hifi (hw:1,0)", "HDMI 0", "HDMI 1", "default")
PLUG_INS = (ALSA, "jack", "pulse", "pipewire", "default")  # of libasound2-plugins, pipewire-alsa
SERVER = (JACK, "yehu-server", "yehu-server voice", "synth", "system")
PIPEWIRE = (JACK, "Built-in Mic", "Built-in Audio")  # its library in place of JACK's
DESKTOP = (PULSE, "nul", "Default Sink")


def there(*lists: tuple[str, ...], kind: str = OUTPUT) -> list[AudioDevice]:
    """What is listed where PortAudio has these host APIs, each with its devices."""
    apis, rows = [], []
    for number, (api, *names) in enumerate(lists):
        for name in names:
            row = {"index": len(rows), "name": name, "hostapi": number}
            row["default_samplerate"] = 48000.0
            for each in (INPUT, OUTPUT):
                row[f"max_{each}_channels"] = 2 if each == kind else 0
                row[f"default_low_{each}_latency"] = 0.005
            rows.append(row)
        last = len(rows) - 1 if names else -1
        apis.append({"name": api} | {f"default_{each}_device": -1 for each in (INPUT, OUTPUT)})
        apis[-1][f"default_{kind}_device"] = last
    portaudio = SimpleNamespace(query_hostapis=lambda: apis, query_devices=lambda: rows)
    other = INPUT if kind == OUTPUT else OUTPUT
    assert devices(portaudio, other) == []
    return devices(portaudio, kind)


@pytest.mark.parametrize("kind", [OUTPUT, INPUT])
def test_sound_servers_come_before_alsa_and_default_devices_before_others(kind):
    listed = there(PLUG_INS, (OSS,), SERVER, DESKTOP, kind=kind)
    synth = f"synth, {JACK}"  # a client; only a server's card is a likely input
    assert [device.full_name for device in listed] == [
        *(f"system, {JACK}", *([synth] if kind == OUTPUT else [])),
        *(f"Default Sink, {PULSE}", f"nul, {PULSE}"),
        *("default, ALSA", "jack, ALSA", "pulse, ALSA", "pipewire, ALSA"),
        *([synth] if kind == INPUT else []),
    ]
    assert [device.index for device in listed if device.host_api == PULSE] == [9, 8]


def test_pipewire_in_jacks_place_is_the_default_output_but_no_default_input():
    for kind, first in [(OUTPUT, f"Built-in Audio, {JACK}"), (INPUT, "default, ALSA")]:
        assert choose(there(PLUG_INS, PIPEWIRE, kind=kind), None, kind).full_name == first
        named = choose(there(PLUG_INS, PIPEWIRE, kind=kind), "JACK", kind)
        assert named.full_name == f"Built-in Audio, {JACK}"


def test_a_device_is_found_by_its_host_api_its_name_or_words_of_it():
    for lists, wanted, found in [
        ([CARDS], None, "default, ALSA"),
        ([CARDS], "ALSA", "default, ALSA"),
        ([CARDS], "hifi", "HiFiBerry DAC: hifi (hw:1,0), ALSA"),
        ([CARDS], "HIFI, alsa", "HiFiBerry DAC: hifi (hw:1,0), ALSA"),
        ([CARDS], "HDMI 1", "HDMI 1, ALSA"),
        ([CARDS], "hdmi 0 alsa", "HDMI 0, ALSA"),
        ([CARDS, (OSS, "HDMI")], "HDMI", "HDMI, OSS"),  # its whole name, though others have it
        ([CARDS, (OSS, "HDMI")], "hdmi oss", "HDMI, OSS"),
        # a server's own host API before ALSA's plug-in
        ([PLUG_INS, SERVER], None, f"system, {JACK}"),
        ([PLUG_INS, SERVER], "JACK", f"system, {JACK}"),
        ([PLUG_INS, SERVER], "jack", f"system, {JACK}"),
        ([PLUG_INS, SERVER], "jack, ALSA", "jack, ALSA"),
        ([PLUG_INS, SERVER], "alsa", "default, ALSA"),
        ([PLUG_INS, SERVER], "system", f"system, {JACK}"),
        ([PLUG_INS, SERVER], f"system, {JACK}", f"system, {JACK}"),
        ([PLUG_INS, SERVER], "pulse", "pulse, ALSA"),
        ([PLUG_INS, DESKTOP], None, f"Default Sink, {PULSE}"),
        ([PLUG_INS, DESKTOP], "pulse", f"Default Sink, {PULSE}"),
        ([PLUG_INS, DESKTOP], "PulseAudio", f"Default Sink, {PULSE}"),
        ([PLUG_INS, DESKTOP, SERVER], None, f"system, {JACK}"),
        # that plug-in where PortAudio does not know the server
        ([PLUG_INS], None, "default, ALSA"),
        ([PLUG_INS], "JACK", "jack, ALSA"),
        ([PLUG_INS], "pulse", "pulse, ALSA"),
        ([PLUG_INS], "PulseAudio", "pulse, ALSA"),
        ([PLUG_INS], "PipeWire", "pipewire, ALSA"),
    ]:
        assert choose(there(*lists), wanted).full_name == found, (wanted, lists)


def test_words_that_fit_none_or_several_are_refused_with_the_names_that_there_are():
    for lists, wanted, said in [
        ([CARDS], "hdmi alsa", r"several .* HDMI 0, ALSA; HDMI 1, ALSA"),
        ([SERVER], "yehu-server", "no audio output matches"),  # its own clients are none
        ([CARDS, SERVER], "usb", r"no audio output matches 'usb' \(there are: system.*HiFiBerry"),
        ([CARDS], "JACK", r"no audio output matches 'JACK'"),
        ([], None, "there is no audio output"),
        ([], "hifi", "there are: none"),
        ([], "nulll", r"\); did you mean null\?"),
    ]:
        with pytest.raises(DeviceError, match=said):
            choose(there(*lists), wanted)
