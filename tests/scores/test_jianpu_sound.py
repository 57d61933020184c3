"""Living notes and slides of jianpu as they sound."""

from __future__ import annotations

import numpy as np
import pytest
from pitch import frame_pitch

from yehu_server.rendering.options import Options
from yehu_server.rendering.performance import Performance
from yehu_server.scores.jianpu.reader import parse_jianpu
from yehu_server.scores.written.notated import Written
from yehu_server.scores.written.performed import performed

RATE = 44100


def sound(text: str, phrasing: float = 0.0) -> tuple[Written, np.ndarray]:
    """A score, and what is heard of it; the player's own vibrato comes with phrasing."""
    written = parse_jianpu(text.encode())
    options = Options(tail_s=0.0, is_dry=True, is_mono=True, phrasing=phrasing)
    performance = Performance(performed(written), options)
    return written, np.concatenate(list(performance.blocks()))


def heard(samples: np.ndarray, at_s: float) -> float:
    """The MIDI note that sounds about a time."""
    middle, half = round(at_s * RATE), RATE // 50
    return 69.0 + 12.0 * np.log2(frame_pitch(samples[middle - half : middle + half], RATE) / 440.0)


def test_a_living_five_sounds_as_its_gesture_moves():
    written, samples = sound("4=60 四 活五 - - - 六")
    note = written.parts[0].notes[1]
    shares, steps = zip(*note.contour, strict=True)
    for at_s in np.arange(1.2, 4.9, 0.1):
        # the finger follows within 25 ms
        near = [
            note.pitch + np.interp((at_s - 1.0 + late) / 4.0, shares, steps)
            for late in (-0.025, 0.0, 0.025)
        ]
        assert min(near) - 0.2 < heard(samples, at_s) < max(near) + 0.2, at_s
    assert heard(samples, 5.5) == pytest.approx(69.0, abs=0.15)


def test_a_marked_slide_and_a_sprung_note_are_heard_after_a_leap():
    _, slid = sound("1=Bb 4=60 6 slideDown 2' -", 0.5)
    assert 73.5 < heard(slid, 1.06) < 74.2
    assert heard(slid, 1.3) == pytest.approx(72.0, abs=0.15)
    _, sprung = sound('1=G 4=60 2 6 ^"跳弓"', 0.5)
    assert heard(sprung, 1.06) == pytest.approx(76.0, abs=0.15)
