"""Who hums into a page's microphone plays: the tune, in a performance that can be kept."""

import json

import numpy as np
import soundfile
from live.page.browser import drive

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


def test_what_is_hummed_is_drawn_kept_in_tune_and_heard(sounding, tmp_path):
    soundfile.write(tmp_path / "voice.wav", hum(), RATE, subtype="PCM_16")
    found = drive("page_voice.mjs", sounding, str(tmp_path / "voice.wav"), str(tmp_path))
    assert found["still"] == 0  # after it was stopped
    assert min(found["pixels"].values()) > 30, found["pixels"]
    commands = [json.loads(line) for line in (tmp_path / "hum.jsonl").read_text().splitlines()[1:]]
    begun = [command[5] for command in commands if "begin" in command]
    octaves = {round(pitch) - 12 * ((round(pitch) - 57) // 12) for pitch in begun}
    assert len(begun) >= 3
    assert octaves <= set(map(int, NOTES))
    assert np.abs(np.array(begun) - np.round(begun)).max() < 0.01  # it was asked to be in tune
    sound, rate = soundfile.read(tmp_path / "hum.wav")
    assert np.sqrt(np.square(sound[rate:]).mean()) > 0.005
