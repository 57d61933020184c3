"""The LV2 bundle: what it declares, and what it plays."""

import os
import shutil
import subprocess

import numpy as np
import pytest
from plugin.lv2_host import Plugin
from plugin.sounds import FRAMES, PHRASE, by_library, frequency

from yehu_server.plugin.carried import carried
from yehu_server.plugin.lv2_texts import FIRST_PARAMETER, in_lv2

slow = pytest.mark.slow


@pytest.fixture
def ports(shown):
    """All ports of parameters at their defaults, and the port of each address."""
    listed = in_lv2(shown.values())
    places = {each.address: FIRST_PARAMETER + i for i, each in enumerate(listed)}
    return {places[each.address]: each.default for each in listed}, places


@slow
def test_it_plays_the_samples_of_the_library(built, library, ports):
    plugin = Plugin(built / "Yehu.lv2" / "Yehu.so", 48000.0, ports[0])
    samples = plugin.play(PHRASE, FRAMES, 441, speed=1.0)
    assert np.array_equal(samples, by_library(library, PHRASE, FRAMES))
    again = plugin.play(PHRASE, 1000, 100, speed=0.0)  # stops, plays on
    assert not np.array_equal(again, samples[:1000])
    plugin.close()


@slow
def test_its_ports_are_its_state(built, ports):
    values, places = ports
    changed = values | {
        places["/mapping"]: 2.0,
        places["/room/level"]: 0.0,
        places["/playing/vibrato"]: 0.0,
    }
    plugin = Plugin(built / "Yehu.lv2" / "Yehu.so", 96000.0, changed)
    bent = [(0, 0x91, 69, 100), (100, 0xE1, 0, 80)]  # by MPE: 12 of 48 semitones
    samples = plugin.play(bent, 96000, 1024)
    assert frequency(samples[48000:], 96000) == pytest.approx(880.0, rel=0.006)
    assert plugin.latency[0] == 64.0
    plugin.close()


@slow
def test_what_a_mapping_moves_is_asked_of_the_host(built, shown, ports):
    values, places = ports
    plugin = Plugin(built / "Yehu.lv2" / "Yehu.so", 48000.0, values)
    mapping, data = places["/mapping"], carried()
    name = next(name for name, starts in data.starts.items() if starts)
    plugin.ports[mapping][0] = shown["/mapping"].choices.index(name)
    plugin.play([], 512, 128)
    moved = {places[address]: value for address, value in data.starts[name].items()}
    assert plugin.requests == pytest.approx(moved)
    plugin.ports[mapping][0] = 0.0  # and back
    plugin.play([], 512, 128)
    assert plugin.requests == pytest.approx({port: values[port] for port in moved})
    plugin.close()


@slow
@pytest.mark.skipif(
    not (shutil.which("lv2_validate") and shutil.which("sord_validate")),
    reason="there is no lv2_validate",
)
def test_the_validator_finds_nothing(built):
    files = sorted(map(str, (built / "Yehu.lv2").glob("*.ttl")))
    done = subprocess.run(
        [shutil.which("lv2_validate"), *files], capture_output=True, text=True, check=False
    )
    assert "Found 0 errors" in done.stdout + done.stderr


@slow
@pytest.mark.skipif(shutil.which("lv2info") is None, reason="there is no lilv")
def test_lilv_finds_plug_in_and_presets(built, tmp_path):
    (tmp_path / "Yehu.lv2").symlink_to(built / "Yehu.lv2")
    printed = subprocess.run(
        [shutil.which("lv2info"), "urn:yehu-server:yehu"],
        env={**os.environ, "LV2_PATH": str(tmp_path)},
        capture_output=True,
        text=True,
        check=True,
    )
    assert not printed.stderr
    assert "sul-ponticello" in printed.stdout
    assert "Finger 4 press by hand" in printed.stdout
    assert '-1 = "up"' in printed.stdout
