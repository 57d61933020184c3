"""Presets and examples are about as loud as each other, so that nobody reaches for the volume."""

import re
from pathlib import Path

import numpy as np
import pytest
from loudness import check, phrase
from measures.bs1770 import lufs

import yehu_server as yehu

PRESETS = ("ordinary", "pizzicato", "sul-tasto", "tremolo", "hall")
OTHERS = ("vibrato", "flautando", "sul-ponticello", "scratch", "dry", "study", "courtyard")

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
MAPPINGS = {
    "slow_air.mid": "keyboard-expressive",
    "bow_pressure.mid": "keyboard-expressive",
    "mpe_phrase.mid": "mpe",
}
SCORES = sorted(
    path.relative_to(EXAMPLES).as_posix()
    for ending in ("mid", "musicxml", "jianpu")
    for path in EXAMPLES.rglob(f"*.{ending}")
)


def test_a_sine_is_as_loud_as_the_standard_says():
    for rate in (44100.0, 48000.0):
        sine = np.sin(2.0 * np.pi * 997.0 * np.arange(2 * rate) / rate)[:, None]
        assert lufs(sine, rate) == pytest.approx(-3.01, abs=0.02)
        assert lufs(np.repeat(0.1 * sine, 2, axis=1), rate) == pytest.approx(-20.0, abs=0.02)


@pytest.mark.parametrize(
    "preset", [*PRESETS, *(pytest.param(name, marks=pytest.mark.slow) for name in OTHERS)]
)
def test_a_phrase_is_within_5_lu_of_loudness_with_each_preset(preset):
    made = yehu.render(phrase(), preset=preset, phrasing=0.0)
    loudness = check(made.sound, made.sample_rate)
    page = (EXAMPLES.parent / "presets" / "README.md").read_text(encoding="utf-8")
    shown = re.search(rf"\| `{preset}` \|.*\| (-[\d.]+) LUFS \|", page)
    assert shown is None or float(shown[1]) == pytest.approx(loudness, abs=0.2)


@pytest.mark.slow
@pytest.mark.parametrize("name", SCORES)
def test_an_example_is_within_5_lu_of_loudness(name):
    mapping = MAPPINGS.get(name)
    made = yehu.render(EXAMPLES / name, **({"mapping": mapping} if mapping else {}))
    check(made.sound, made.sample_rate)


def test_plucks_that_a_score_asks_for_are_as_much_softer_in_a_hall_as_elsewhere(tmp_path):
    score = tmp_path / "pizz.jianpu"
    score.write_text('1=F 4=120\n1 1 1 1 | 1 ^"pizz." 1 1 1 |\n', encoding="utf-8")

    def below_bowed_db(room: str) -> float:
        made = yehu.render(score, preset=room, settings={"/room/level": 0.0}, phrasing=0.0)
        bowed, plucked = (
            np.abs(made.sound[round(begin * made.sample_rate) :][: 2 * 44100]).max()
            for begin in (0.0, 2.05)
        )
        return float(20.0 * np.log10(bowed / plucked))

    assert below_bowed_db("hall") == pytest.approx(below_bowed_db("chamber"), abs=1.0)
