"""A section that plays, each player heard alone."""

from __future__ import annotations

import os
from dataclasses import replace
from typing import Any

import numpy as np

from yehu_server.core.engine.ensemble import Ensemble
from yehu_server.core.player.commands import BEGIN
from yehu_server.playing.calibration_store import calibration_for
from yehu_server.playing.options import PlayingOptions
from yehu_server.playing.part_state import Key
from yehu_server.playing.parts import SECTION, section_specs
from yehu_server.rendering.cores import Cores, shared

BLOCK_S = 1.0


class SectionTake:
    """A section of a number of players, without a room."""

    def __init__(self, rate: float, seed: int, players: int) -> None:
        playing = replace(PlayingOptions(seed=seed), start=((SECTION, float(players)),))
        specs = section_specs(playing, rate, calibration_for(rate), players=players)
        self.rate = rate
        self._ensemble = Ensemble(specs, has_room=False)
        self.instruments = self._ensemble.instruments
        for instrument in self.instruments:
            instrument.report_commands()
        self.player = playing.mapped(playing.player(self.instruments))
        self.begun: list[list[int]] = [[] for _ in self.instruments]  # frames of onsets

    def note(self, note: float, begin_s: float, end_s: float, velocity: int = 80) -> None:
        """Schedule a note; notes come in the order of their beginnings."""
        key = Key(0, note)
        self.player.key_on(key, velocity, frame=round(begin_s * self.rate))
        self.player.key_off(key, frame=round(end_s * self.rate))

    def play(self, seconds: float) -> Any:
        """Return the sound of each player [shape=(players, frames)]."""
        frames, block = round(seconds * self.rate), round(BLOCK_S * self.rate)
        sounds = np.zeros((len(self.instruments), frames), np.float32)
        with shared(os.cpu_count() or 1) as share:
            cores = Cores(self._ensemble, share, has_stems=True)
            for begin in range(0, frames, block):
                end = min(begin + block, frames)
                cores.mix(cores.sound(end - begin))
                for number, instrument in enumerate(self.instruments):
                    sounds[number, begin:end] = cores.stems[:, number].mean(axis=1)
                    commands = instrument.applied_commands()
                    self.begun[number] += commands["frame"][commands["kind"] == BEGIN].tolist()
        return sounds
