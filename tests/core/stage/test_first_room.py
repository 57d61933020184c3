"""The room where nothing is said is a chamber: clear, alive, and about the listener [ISO3382]."""

import math

import numpy as np
import pytest
from acoustics import clarity_db, early_correlation, early_decay_time, octaves_from
from stages import ADDRESSES, DEFAULTS, NAMES, SMALL, Stage, response, stage_inputs

from yehu_server.playing.preset_folders import Presets

RATES = [44100.0, 48000.0, 96000.0]
# Single figures are means of octaves [ISO3382].
MIDDLE, EARS = (500.0, 1000.0), (500.0, 1000.0, 2000.0)


@pytest.mark.parametrize("decay", [0.4, 0.8, 1.6])
def test_clarity_and_early_decay_of_an_exponential_decay_are_the_closed_forms(decay):
    rate = 48000.0
    at = np.arange(round(3.0 * decay * rate)) / rate
    amplitude = np.exp(-3.0 * math.log(10.0) / decay * at)[:, None]
    early = 10.0 ** (6.0 * 0.08 / decay)  # what there was over what is left after 80 ms
    assert clarity_db(amplitude, rate) == pytest.approx(10.0 * math.log10(early - 1.0), abs=0.01)
    assert early_decay_time(amplitude, rate) == pytest.approx(decay, rel=0.01)


def test_a_direct_sound_adds_to_clarity_and_not_to_what_is_left():
    rate = 48000.0
    heard = np.zeros((9600, 1))
    heard[0], heard[round(0.079 * rate)], heard[round(0.081 * rate)] = 1.0, 0.5, 0.25
    assert clarity_db(heard, rate) == pytest.approx(10.0 * math.log10(1.25 / 0.0625))


@pytest.mark.parametrize(("late_ms", "least", "most"), [(0.0, 1.0, 1.0), (0.5, 0.98, 1.0),
                                                        (3.0, 0.0, 0.1)])  # fmt: skip
def test_ears_are_correlated_where_one_hears_the_other_within_a_millisecond(late_ms, least, most):
    rate = 48000.0
    noise = np.random.default_rng(2).normal(size=round(0.1 * rate))
    late = round(1e-3 * late_ms * rate)
    both = np.column_stack([noise[late:], noise[: len(noise) - late]])
    assert least - 1e-9 <= early_correlation(both, rate) <= most + 1e-9


def test_independent_ears_are_correlated_as_their_shares_of_a_common_sound():
    rate = 48000.0
    common, left, right = np.random.default_rng(3).normal(size=(3, round(0.1 * rate)))
    both = np.column_stack([common + left, common + right])  # half of each is common
    assert early_correlation(both, rate) == pytest.approx(0.5, abs=0.05)


@pytest.fixture(scope="module", params=RATES)
def chamber(request):
    direct, room = response(request.param, 1.4)
    return request.param, direct + room


@pytest.mark.parametrize("is_mono", [False, True], ids=["stereo", "mono"])
def test_the_first_room_is_as_clear_as_a_chamber_and_decays_as_one(chamber, is_mono):
    rate, heard = chamber
    if is_mono:
        heard = heard.mean(axis=1, keepdims=True)
    bands = octaves_from(heard, rate, MIDDLE)
    assert 5.0 < np.mean([clarity_db(band, rate) for band in bands]) < 8.0
    assert 0.5 < np.mean([early_decay_time(band, rate) for band in bands]) < 0.9
    assert 0.5 < early_decay_time(heard, rate) < 0.9
    # What both ears hear differently is softer in their mean.
    assert 5.0 < clarity_db(heard, rate) < (9.0 if is_mono else 8.0)


def test_the_first_room_is_about_the_listener(chamber):
    rate, heard = chamber
    assert early_correlation(heard, rate) < 0.75
    bands = octaves_from(heard, rate, EARS)
    assert np.mean([early_correlation(band, rate) for band in bands]) < 0.75


def test_what_enters_at_the_middle_comes_as_loud_to_both_ears(chamber):
    left, right = np.sum(np.square(chamber[1]), axis=0)
    assert 10.0 * math.log10(left / right) == pytest.approx(0.0, abs=1.0)


def test_the_chamber_is_the_default_and_the_study_stays_nearly_anechoic():
    named = {**dict(zip(ADDRESSES, NAMES, strict=True)), "/body/gain": "gain"}

    def room(name: str) -> dict[str, float]:
        return {named[address]: value for address, value in Presets().load(name).values.items()}

    usual = {name: value for name, value in DEFAULTS.items() if name != "pan"}
    assert room("chamber") == {**usual, "gain": 0.0}
    study = room("study")
    assert study.pop("gain") == 0.0
    assert study == {
        "size": 5.0, "decay": 0.4, "damping": 0.4, "level": 0.15, "distance": 2.0, "width": 0.3,
    }  # fmt: skip
    assert clarity_db(sum(response(48000.0, 0.8, **study)), 48000.0) > 19.0


def test_without_a_room_one_who_sits_where_players_do_is_the_instrument_to_the_bit():
    dry = SMALL * np.random.default_rng(4).normal(size=4800)
    stage = Stage(48000.0, has_room=False)
    for distance, share in ((3.5, 1.0), (7.0, 0.5)):
        stage.settle(0.1, distance=distance)
        heard = stage.play(dry, stage_inputs(len(dry), distance=distance))[1][:, 0]
        assert np.array_equal(heard, share * np.column_stack([dry, dry]))
