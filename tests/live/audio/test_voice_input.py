"""The input of a voice: what it gets of the tuning, and an input that stalls."""

import math
import queue

import numpy as np
import pytest

from yehu_server.core.player.note_range import YEHU
from yehu_server.core.voice.note_detection import FOLLOWER, ends_of
from yehu_server.live.audio import stream
from yehu_server.live.audio.devices import INPUT
from yehu_server.live.audio.voice_input import tuned_as
from yehu_server.playing.options import PlayingOptions


class ToldError(Exception):
    """What the process says as it ends."""


class Ending:
    """A parent, and a queue of orders that has none, without waiting."""

    def send(self, event: str, **_fields: object) -> None:
        raise ToldError(event)

    def get(self, **_within: float) -> None:
        raise queue.Empty


class Heard:
    """An input that hears something new each time, up to so much; an output where that is None."""

    is_active = True

    def __init__(self, most: int | None) -> None:
        self.most, self.asked = most, 0

    @property
    def heard(self) -> int | None:
        self.asked += 1
        if self.asked > 10 * stream.STALLED:
            self.is_active = False  # to end the test
        return None if self.most is None else min(self.asked, self.most)


def test_an_input_that_gives_nothing_new_is_lost():
    asked = {}
    for most in (0, 30, 10**9, None):
        source = Heard(most)
        with pytest.raises(ToldError, match="lost"):
            stream._watch(Ending(), Ending(), source)
        asked[most] = source.asked
    assert asked[0] <= stream.STALLED + 2
    assert asked[30] <= stream.STALLED + 32
    assert asked[10**9] == asked[None] > 9 * stream.STALLED  # these go on


def test_a_follower_has_the_notes_and_the_tuning_of_its_instrument():
    fields = ends_of(YEHU) | tuned_as(PlayingOptions(a4=415.0))
    order = {"kind": INPUT, "rate": 48000.0, "transpose": 12.0, "correct": 0.5, "fields": fields}
    _, voice = stream._following(0, order)
    assert voice.dtype == FOLLOWER
    assert (voice["lowest"][0], voice["highest"][0]) == YEHU.ends
    assert voice["a4_offset"][0] == pytest.approx(12.0 * math.log2(440.0 / 415.0))
    assert (voice["transpose"][0], voice["correct"][0]) == (12.0, 0.5)
    assert np.array_equal(voice["tuning"][0], np.arange(128.0))
