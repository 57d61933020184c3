"""A section that plays, each player heard alone."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from typing import Any

import numpy as np

from yehu_server.engine.instrument import Instrument
from yehu_server.player.wishes import BEGIN
from yehu_server.playing.calibrations import calibration_for
from yehu_server.playing.section import section_wishes
from yehu_server.playing.section_people import SECTION, section_makes
from yehu_server.playing.style import Style
from yehu_server.playing.wishes import Key

BLOCK_S = 1.0


class SectionTake:
    """A section of a number of people, without a room."""

    def __init__(self, rate: float, seed: int, people: int) -> None:
        style = replace(Style(seed=seed), start=((SECTION, float(people)),))
        makes = section_makes(style, rate, calibration_for(rate), people=people)
        self.rate = rate
        self.instruments: list[Instrument] = [make(None) for make in makes]
        for instrument in self.instruments:
            instrument.report_wishes()
        self.wishes = section_wishes(style, self.instruments)
        self.midi = style.midi(self.wishes)
        self.begun: list[list[int]] = [[] for _ in self.instruments]  # frames of onsets

    def note(self, note: float, begin_s: float, end_s: float, velocity: int = 80) -> None:
        """Schedule a note; notes come in the order of their beginnings."""
        key = Key(0, note)
        self.midi.note_on(key, velocity / 127.0, round(begin_s * self.rate))
        self.midi.note_off(key, round(end_s * self.rate))

    def play(self, seconds: float) -> Any:
        """Return the sound of each player [shape=(players, frames)]."""
        frames = round(seconds * self.rate)
        sounds = np.zeros((len(self.instruments), frames), np.float32)
        with ThreadPoolExecutor() as pool:
            list(pool.map(self._play, range(len(self.instruments)), sounds))
        return sounds

    def _play(self, number: int, sound: Any) -> None:
        instrument, block = self.instruments[number], round(BLOCK_S * self.rate)
        for begin in range(0, len(sound), block):
            instrument.process(sound[begin : begin + block])
            wishes = instrument.applied_wishes()
            self.begun[number] += wishes["frame"][wishes["kind"] == BEGIN].tolist()
