"""After a change of strings the new note is heard, and the string that was left is not."""

import numpy as np
import pytest

import yehu_server as yehu

RATE, EACH_S = 22050, 0.4
PAIRS = ((74, 67), (79, 67), (75, 68), (77, 65), (73, 66), (76, 69), (81, 67), (74, 66))
FROM_S, TO_S = 0.05, 0.08  # after the beat


def amplitude(sound: np.ndarray, frequency: float) -> float:
    phase = 2j * np.pi * frequency * np.arange(len(sound)) / RATE
    return float(abs(np.sum(sound * np.hanning(len(sound)) * np.exp(-phase))))


@pytest.mark.parametrize("overlap_s", [0.0, 0.01], ids=["separate", "slurred"])
def test_the_string_that_the_bow_left_does_not_outshine_the_next_note(overlap_s):
    """It is stopped by the same finger, a fifth above: both together sound an octave low."""
    keys = [key for pair in PAIRS for key in pair]
    notes = [(key, i * EACH_S, EACH_S + overlap_s) for i, key in enumerate(keys)]
    is_heard = []
    for seed in range(6):
        sound = yehu.render(notes, phrasing=0.0, seed=seed, sample_rate=RATE, dry=True, mono=True)
        for i in range(1, len(keys), 2):
            beat = i * EACH_S
            part = sound.sound[round((beat + FROM_S) * RATE) : round((beat + TO_S) * RATE)]
            own = 440.0 * 2.0 ** ((keys[i] - 69) / 12.0)
            harmonics = np.hypot.reduce([amplitude(part, own * n) for n in range(1, 7)])
            is_heard.append(amplitude(part, 1.5 * own) < 0.3 * harmonics)
    assert np.mean(is_heard) > 0.75
