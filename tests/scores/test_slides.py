"""Slides over leaps in files leave the note before and are on their pitch on the beat."""

from collections.abc import Iterator
from dataclasses import replace

import mido
import numpy as np
import pytest
from shaping import phrased

import yehu_server as yehu
from yehu_server.api.notes import score_of as score_of_notes
from yehu_server.core.player.parameter_indices import INDEX
from yehu_server.params.articulations import NUMBER
from yehu_server.playing.options import PlayingOptions
from yehu_server.rendering.options import Options, Part
from yehu_server.rendering.performance import Performance
from yehu_server.scores.events import Events, ScoreEvent, Setting
from yehu_server.scores.score import Score
from yehu_server.scores.slides import logistic

BEND, STRING = "/playing/bend", "/playing/string"
HALVES = 0.5  # s
RATE = 22050


def score_of(*keys: int, each_s: float = HALVES, at_first: tuple[Setting, ...] = ()) -> Score:
    """Notes one after another, and settings before the first."""
    events = [ScoreEvent(0.0, setting, 0.0) for setting in at_first]
    for number, key in enumerate(keys):
        begin, end = number * each_s, (number + 1) * each_s
        events.append(ScoreEvent(begin, mido.Message("note_on", note=key, velocity=80), begin))
        events.append(ScoreEvent(end, mido.Message("note_off", note=key), end))
    return Score(Events.of(events), len(keys) * each_s)


def settings(score: Score, address: str) -> list[tuple[float, float | None]]:
    return [
        (event.time_s, event.message.value)
        for event in score.events
        if isinstance(event.message, Setting) and event.message.address == address
    ]


def heard_about(sound: np.ndarray, at_s: float, low: int, high: int) -> float:
    """The pitch (MIDI note), of those about two, at which 36 ms about a time are most periodic."""
    part = sound[round((at_s - 0.018) * RATE) : round((at_s + 0.018) * RATE)]
    pitches = np.arange(low - 2.0, high + 2.0, 0.05)
    lags = RATE / (440.0 * 2.0 ** ((pitches - 69.0) / 12.0))
    power = np.abs(np.fft.rfft(part * np.hanning(len(part)), 1 << 14)) ** 2
    likeness = np.fft.irfft(power)
    return float(pitches[np.argmax(np.interp(lags, np.arange(len(likeness)), likeness))])


def slid(score: Score, amount: float = 0.5) -> Score:
    return phrased(score, amount)


def test_a_slide_is_a_bend_of_the_note_before_that_ends_on_the_beat():
    """Slow at its ends, and quick in its middle."""
    for keys, leap in (((74, 79), 5.0), ((79, 74), -5.0), ((67, 76), 9.0)):
        played = slid(score_of(*keys))
        assert [(n.start_s, n.key) for n in played.notes] == [(0.0, keys[0]), (HALVES, keys[1])]
        times, bends = np.array(settings(played, BEND)).T
        assert bends[-1] == pytest.approx(leap)
        assert times[-1] + 0.008 == pytest.approx(HALVES)  # a bend takes 8 ms
        assert 0.1 < times[-1] - times[0] < 0.42 * HALVES
        assert (np.diff(bends) * leap > 0.0).all()
        half = np.interp(0.5 * leap, np.sort(bends), times if leap > 0.0 else times[::-1])
        assert half == pytest.approx(np.mean([times[0], times[-1]]), abs=0.006)
    steps = np.diff([logistic(n / 20) for n in range(21)])
    assert steps.sum() == pytest.approx(1.0)
    assert steps == pytest.approx(steps[::-1])
    assert (np.diff(steps[:10]) > 0.0).all()
    assert steps[9] > 2.0 * steps[0]


def test_only_leaps_that_hands_are_free_for_slide():
    articulation = "/playing/articulation"
    never = {
        "an octave": score_of(67, 79),
        "short notes": score_of(74, 79, each_s=0.25),
        "to the open string F4": score_of(72, 65),
        "beyond the inner string": score_of(71, 77),
        "a written outer string": score_of(74, 67, at_first=(Setting(STRING, 2.0),)),
        "plucked": score_of(74, 79, at_first=(Setting("/playing/pizzicato", 1.0),)),
        "portamento": score_of(74, 79, at_first=(Setting("/playing/portamento", 1.0),)),
        "bent": score_of(74, 79, at_first=(Setting(BEND, 0.3),)),
        "staccato": score_of(74, 79, at_first=(Setting(articulation, NUMBER["staccato"]),)),
        "left hand by itself": score_of(74, 79, at_first=(Setting("/playing/left_hand", 0.0),)),
        "no phrasing": score_of(74, 79, at_first=(Setting("/playing/phrasing", 0.0),)),
    }
    found = [name for name, score in never.items() if len(settings(slid(score), BEND)) > 1]
    assert not found
    assert settings(phrased(score_of(74, 79), 0.0), BEND) == []
    rolled = (Setting(articulation, NUMBER["rolling-vibrato"]),)
    assert settings(slid(score_of(74, 79, at_first=rolled)), BEND)


def test_some_steps_slide_by_the_seed_and_more_of_the_wider_and_rising_ones():
    def share(low: int, high: int) -> float:
        score = score_of(*[low, high] * 100)
        found = [
            {round(time / HALVES) for time, value in settings(slid_by(score, seed), BEND) if value}
            for seed in range(4)
        ]
        assert found[0] != found[1]
        return float(np.mean([len(each) for each in found])) / 199

    def slid_by(score: Score, seed: int) -> Score:
        return phrased(score, 0.5, PlayingOptions(seed=seed))

    assert 0.14 < share(74, 76) < 0.25 < share(74, 77) < 0.36
    again = [settings(slid_by(score_of(*[74, 76] * 9), 3), BEND) for _ in range(2)]
    assert again[0] == again[1]
    still = Setting("/playing/variation", 0.0)  # then no seed changes anything
    found = [slid_by(score_of(*[74, 77] * 9, at_first=(still,)), seed) for seed in (0, 3)]
    assert found[0] == found[1]
    assert settings(found[0], BEND)


@pytest.mark.parametrize("keys", [(74, 79), (79, 74), (74, 67)])
def test_the_finger_is_heard_to_leave_before_the_beat_and_to_be_there_on_it(keys):
    """By four of five players at least, each with a seed of its own."""
    notes = [(keys[0], 0.0, HALVES), (keys[1], HALVES, HALVES)]
    for phrasing, is_on_the_way in ((0.0, False), (0.5, True)):
        usual = {"phrasing": phrasing, "sample_rate": RATE, "dry": True, "mono": True}
        heard, right = [], 0
        for seed in range(5):
            sound = yehu.render(notes, seed=seed, **usual).sound
            before, after = (heard_about(sound, HALVES + s, *sorted(keys)) for s in (-0.065, 0.05))
            was_on_the_way = min(keys) + 1.0 < before < max(keys) - 1.0
            right += abs(after - keys[1]) < 0.3 and was_on_the_way == is_on_the_way
            heard.append((before, after))
        assert right >= 4, (phrasing, heard)


def watched(seconds: tuple[float, float], playing: PlayingOptions) -> Iterator[Performance]:
    """A slide from G5 to D5, each 10 ms; how long both last."""
    score = score_of_notes([(79, 0.0, seconds[0]), (74, 0.5, seconds[1])])
    part = Part(phrased(score, 0.5, playing), replace(playing, phrasing=0.5))
    performance = Performance([part], Options(block=441, is_dry=True, is_mono=True))
    for _ in performance.blocks():
        yield performance


@pytest.mark.parametrize("overlap_s", [0.0, 0.012])
def test_the_second_note_takes_the_finger_where_it_is(overlap_s):
    """On its string, without a step, whether slurred or not."""
    still = {"/playing/variation": 0.0, "/playing/listening": 0.0}
    places = []
    for performance in watched((0.5 + overlap_s, 0.5), PlayingOptions(settings=(*still.items(),))):
        player = performance.instrument._rig["player"][0]
        places.append((int(player["string"]), int(player["finger"]), float(player["position"])))
    before, after = places[48], places[60]
    assert after[:2] == before[:2]
    assert after[2] == pytest.approx(before[2], abs=2e-3)
    assert abs(places[30][2] - after[2]) > 0.02


def test_everybody_of_a_section_slides_and_is_on_the_note():
    bends = np.array([
        [each._rig["player"][0]["value"][INDEX[BEND]] for each in performance.ensemble.instruments]
        for performance in watched((0.5, 0.5), PlayingOptions(start=(("/playing/section", 3.0),)))
    ])  # fmt: skip
    assert bends.shape[1] == 3
    assert (bends.min(axis=0) < -4.5).all()
    assert (bends[65:] == 0.0).all()
