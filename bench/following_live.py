"""How well and how soon a voice is followed as it sings: `serve --follow`, and the page.

    .venv/bin/python bench/following_live.py --save bench/results/following_live.json

The sounds are those of bench/following.py, and more instruments of the bank, plain and with noise.
Time is that of the sound, in blocks of 128 samples: an audio device adds its own. Attacks of the
bank's instruments, some of which are slow, count as lateness.
"""

from __future__ import annotations

import argparse
import math
from typing import Any

import numpy as np
import report
from following import (
    CONDITIONS,
    FINE_CENTS,
    HOP_S,
    NEAR_CENTS,
    RATE,
    f1,
    of_bank,
    sounds,
    truth,
)

from yehu_server.core.engine.voice_callback import OF_WISH, follow_voice, voice_pitch, voice_prepare
from yehu_server.core.player.wishes import BEGIN
from yehu_server.core.voice.deciding import FOLLOWER

Array = Any

MORE = {"oboe": 68, "clarinet": 71, "saxophone": 65, "cello": 42, "horn": 60, "choir": 52}
HEARD_WITH = ("plain", "noise, 20 dB")
BLOCK, ROOM = 128, 64  # samples; wishes
OCTAVE_CENTS, SEMITONE_CENTS = 1200.0, 100.0
LATEST_S, STEP_S = 0.08, 0.0025  # of what is heard after what was sung


def followed(sound: Array) -> tuple[Array, Array, Array]:
    """The times of blocks, the pitch that is followed after each (NaN: none), and the onsets."""
    voice, wishes = np.zeros(1, FOLLOWER), np.zeros((ROOM, OF_WISH))
    voice_prepare.call(voice.ctypes.data, float(RATE), math.nan, 0.0)
    sound = np.ascontiguousarray(sound, np.float32)
    ends = np.arange(BLOCK, len(sound), BLOCK)
    pitch, onsets = [], []
    for end in ends:
        block = sound[end - BLOCK : end]
        count = follow_voice.call(
            voice.ctypes.data, block.ctypes.data, BLOCK, wishes.ctypes.data, ROOM
        )
        onsets += [end / RATE] * int((wishes[:count, 0] == BEGIN).sum())
        pitch.append(voice_pitch.call(voice.ctypes.data))
    return ends / RATE, np.array(pitch), np.array(onsets)


def judged(sound: Array, shift: float) -> dict[str, float]:
    """What is heard of a sound that lies so many semitones higher, at the lag that fits best."""
    pitch, _, wanted = truth()
    known = np.isfinite(pitch)
    at = np.arange(len(pitch)) * HOP_S
    times, heard, onsets = followed(sound)
    best: dict[str, float] = {}
    for lag in np.arange(0.0, LATEST_S, STEP_S):
        place = np.clip(np.searchsorted(times, at + lag), 0, len(times) - 1)
        off = 100.0 * (heard[place] - pitch - shift)[known]
        octaves = np.rint(off / OCTAVE_CENTS)
        is_octave = (octaves != 0.0) & (np.abs(off - OCTAVE_CENTS * octaves) <= SEMITONE_CENTS)
        runs = "".join("x" if each else " " for each in is_octave).split()
        found = {
            "RPA": float(np.mean(np.abs(off) <= NEAR_CENTS)),
            "within 10 cents": float(np.mean(np.abs(off) <= FINE_CENTS)),
            "octave errors": float(np.mean(is_octave)),
            "longest, ms": 1e3 * HOP_S * max(map(len, runs), default=0),
            "later, ms": 1e3 * lag,
            "onsets F1": f1(wanted, onsets - lag),
        }
        if not best or found["within 10 cents"] > best["within 10 cents"]:
            best = found
    return best


def measure(_arguments: argparse.Namespace) -> dict[str, dict[str, Any]]:
    rows = {}
    more = {name: (of_bank(program), 0.0) for name, program in MORE.items()}
    for name, (sound, shift) in (sounds() | more).items():
        scaled = 0.3 * sound / np.abs(sound).max()
        for condition in HEARD_WITH:
            rows[f"{name}, {condition}"] = judged(CONDITIONS[condition](scaled), shift)
    return rows


if __name__ == "__main__":
    report.run(__doc__, measure)
