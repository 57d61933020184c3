"""Who hums into a page's microphone plays: the tune, in a performance that can be kept."""

from __future__ import annotations

import json

import numpy as np
import pytest
import soundfile
from live.page.browser import drive, missing, running

from yehu_server.live.page.site import server_of, url_of, write_page

pytestmark = pytest.mark.skipif(missing() is not None, reason=str(missing()))
RATE, NOTES, SHARP = 48000, (57.0, 60.0, 64.0), 0.3


def hum() -> np.ndarray:
    """Three notes of a voice that is too high, again and again."""
    time = np.arange(int(0.5 * RATE)) / RATE
    fade = np.clip(np.minimum(time, time[::-1]) / 0.02, 0.0, 1.0)
    notes = []
    for note in NOTES:
        phase = 2.0 * np.pi * 440.0 * 2.0 ** ((note + SHARP - 69.0) / 12.0) * time
        tone = sum(np.sin(k * phase) / k for k in range(1, 9))
        notes += [0.1 * fade * tone, np.zeros(int(0.2 * RATE))]
    return np.tile(np.concatenate(notes), 8)


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    """What the page did, and the folder of what it kept."""
    site, folder = (tmp_path_factory.mktemp(name) for name in ("site", "downloads"))
    write_page(site)
    soundfile.write(folder / "voice.wav", hum(), RATE, subtype="PCM_16")
    with running(server := server_of(site, 0)):
        told = drive("page_voice.mjs", url_of(server), str(folder / "voice.wav"), str(folder))
    return told, folder


def test_it_follows_without_an_error_until_it_is_stopped(found):
    told, _ = found
    assert told["errors"] == []
    assert told["still"] == 0


def test_what_is_heard_is_drawn_beside_what_is_played(found):
    told, _ = found
    assert min(told["pixels"].values()) > 30, told["pixels"]


def test_what_is_kept_has_the_notes_that_were_hummed(found):
    _, folder = found
    wishes = [json.loads(line) for line in (folder / "hum.jsonl").read_text().splitlines()[1:]]
    begun = [wish[5] for wish in wishes if "begin" in wish]
    octaves = {round(pitch) - 12 * ((round(pitch) - 57) // 12) for pitch in begun}
    assert len(begun) >= 3
    assert octaves <= set(map(int, NOTES))
    assert np.abs(np.array(begun) - np.round(begun)).max() < 0.01  # it was asked to be in tune


def test_it_is_heard(found):
    _, folder = found
    sound, rate = soundfile.read(folder / "hum.wav")
    assert np.sqrt(np.square(sound[rate:]).mean()) > 0.005
