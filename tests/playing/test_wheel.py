"""With the default mapping the mod wheel draws the bow or plucks; aftertouch rocks the finger."""

from collections.abc import Sequence
from pathlib import Path

import mido
import numpy as np
import pytest

import yehu_server as yehu

RATE = 22050
KEYS = (67, 74, 79)
SEEDS = (1, 2, 3)  # a note is judged over some


@pytest.fixture
def rendered(tmp_path: Path):
    """A function that renders a note of 2.1 s with some messages, and returns its middle."""

    def render(
        key: int,
        messages: Sequence[mido.Message],
        seed: int,
        before: Sequence[mido.Message] = (),
        part: slice = slice(RATE, 2 * RATE),
        **options: str,
    ) -> np.ndarray:
        note = mido.Message("note_on", note=key, velocity=80)
        end = mido.Message("note_off", note=key, time=2016)
        track = mido.MidiTrack([*before, note, *messages, end])
        path = tmp_path / "note.mid"
        mido.MidiFile(tracks=[track]).save(path)
        more = {"phrasing": 0.0, "dry": True, "mono": True, "sample_rate": RATE}
        return yehu.render(path, seed=seed, **more, **options).sound[part]

    return render


def wheel(*positions: int) -> list[mido.Message]:
    return [mido.Message("control_change", control=1, value=value) for value in positions]


def level_db(sound: np.ndarray) -> float:
    return float(10.0 * np.log10(np.mean(np.square(sound)) + 1e-12))


def width_cents(sound: np.ndarray, key: int) -> float:
    """How far the pitch of the first harmonic sways at 4 to 9 Hz, to either side."""
    frequency = 440.0 * 2.0 ** ((key - 69) / 12.0)
    shifted = sound * np.exp(-2j * np.pi * frequency * np.arange(len(sound)) / RATE)
    window = np.hanning(round(8.0 * RATE / frequency) | 1)
    phase = np.unwrap(np.angle(np.convolve(shifted, window / window.sum(), "valid")))
    ratio = 1.0 + np.diff(phase) * RATE / (2.0 * np.pi * frequency)
    cents = 1200.0 * np.log2(np.clip(ratio, 0.9, 1.1))  # beyond it the harmonic was gone a moment
    spectrum = np.fft.rfft((cents - cents.mean()) * np.hanning(len(cents)))
    hertz = np.fft.rfftfreq(len(cents), 1.0 / RATE)
    return float(4.0 * np.abs(spectrum[(hertz > 4.0) & (hertz < 9.0)]).max() / len(cents))


def median_width(rendered, key: int, messages: Sequence[mido.Message], **named: str) -> float:
    widths = [width_cents(rendered(key, messages, seed, **named), key) for seed in SEEDS]
    return float(np.median(widths))


def test_the_wheel_moves_the_level_over_some_20_db_and_never_to_silence(rendered) -> None:
    def level(key: int, messages: Sequence[mido.Message]) -> float:
        return float(np.median([level_db(rendered(key, messages, seed)) for seed in SEEDS]))

    for key in KEYS:
        levels = [level(key, wheel(127, value)) for value in (0, 64, 127)]
        assert (np.diff(levels) > 5.0).all(), (key, levels)
        assert 17.0 < levels[-1] - levels[0] < 22.0, (key, levels)
    assert level(74, wheel(127, 95)) == pytest.approx(level(74, []), abs=1.0)


def test_a_wheel_that_stays_down_or_is_reset_counts_as_not_moved(rendered) -> None:
    untouched = rendered(74, [], 1)
    np.testing.assert_array_equal(rendered(74, wheel(0, 0), 1), untouched)
    reset = mido.Message("control_change", control=121, value=0)
    assert level_db(rendered(74, [*wheel(30), reset], 1)) == pytest.approx(
        level_db(untouched), abs=0.5
    )
    assert level_db(rendered(74, wheel(1, 0), 1)) < level_db(untouched) - 10.0


def test_expression_multiplies_down_to_the_bow_leaving_the_string(rendered) -> None:
    soft = mido.Message("control_change", control=11, value=40)
    off = mido.Message("control_change", control=11, value=0)
    louder = [level_db(rendered(74, [*wheel(value), soft], 0)) for value in (20, 60, 120)]
    assert (np.diff(louder) > 4.0).all()
    assert level_db(rendered(74, [*wheel(127), off], 0)) < -70.0


@pytest.mark.parametrize("kind", ["aftertouch", "polytouch"])
def test_aftertouch_rocks_the_finger_the_more_the_harder_it_is(rendered, kind: str) -> None:
    for key in KEYS if kind == "aftertouch" else KEYS[:1]:
        own = {"note": key} if kind == "polytouch" else {}
        values = (0, 80, 127)
        presses = {value: mido.Message(kind, value=value, **own) for value in values}
        widths = [median_width(rendered, key, [presses[value]]) for value in values]
        assert widths[0] < 3.5, (key, widths)
        assert widths[0] < widths[1] < widths[2], (key, widths)
        assert widths[2] > 4.0, (key, widths)


def test_a_mapping_keeps_vibrato_on_the_wheel(rendered) -> None:
    named = {"mapping": "keyboard-vibrato-wheel"}
    widths = [median_width(rendered, 74, wheel(value), **named) for value in (1, 127)]
    assert widths[0] < 6.0
    assert widths[1] > 20.0


def test_plucks_follow_the_wheel_and_expression_as_the_bow_does(rendered) -> None:
    def level(*controls: tuple[int, int]) -> float:
        plucked = ((67, 127), *controls)
        before = [mido.Message("control_change", control=c, value=value) for c, value in plucked]
        return level_db(rendered(74, [], 1, before, slice(RATE // 2)))

    assert 17.0 < level((1, 127)) - level((1, 1)) < 24.0
    assert level((11, 40)) < level() - 14.0
    assert level((11, 0)) < level() - 40.0
