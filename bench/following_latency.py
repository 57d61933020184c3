"""From a voice to the sound that follows it: `serve --follow` over JACK's dummy driver.

    .venv/bin/python bench/following_latency.py [--notes N] [--save bench/results/NAME.json]

A JACK client in another process sings notes with rests between them and records what is played,
both by the frames of its own callback. Of each note: the time from its first sample to the first
that is louder than the rest before it by 20 dB, and to the first at half of the note's own peak.
The device's own latency comes on top.
"""

from __future__ import annotations

import argparse
import os
import sys
import time
from typing import Any

import numpy as np
import report
from endurance import Playing
from load import CARD, JACK, dummy_jack, helper

RATE = 48000
BLOCKS = (64, 128, 256)
PITCHES = (53.0, 57.0, 60.0, 65.0, 69.0)  # of the voice, in turn
NOTE_S, REST_S, ATTACK_S = 0.5, 0.7, 0.015
AUDIBLE, LEAST = 10.0, 1e-5  # times the rest before; of full scale


def song(notes: int) -> tuple[np.ndarray, np.ndarray]:
    """Sung notes, and the frames at which they begin."""
    time_s = np.arange(int(NOTE_S * RATE)) / RATE
    fade = np.clip(np.minimum(time_s, time_s[::-1]) / ATTACK_S, 0.0, 1.0)
    rest = np.zeros(int(REST_S * RATE), np.float32)
    parts, starts = [rest, rest], []
    for number in range(notes):
        pitch = PITCHES[number % len(PITCHES)]
        phase = 2.0 * np.pi * 440.0 * 2.0 ** ((pitch - 69.0) / 12.0) * time_s
        starts.append(sum(map(len, parts)))
        parts += [0.1 * fade * sum(np.sin(k * phase) / k for k in range(1, 13)), rest]
    return np.concatenate(parts).astype(np.float32), np.array(starts)


def sing(notes: int, answer: Any) -> None:
    """Sing, record, and answer with latencies (ms) to what is heard and to half of the peak."""
    import jack  # type: ignore[import-untyped]

    for silence in (jack.set_error_function, jack.set_info_function):
        silence(lambda _message: None)
    voice, starts = song(notes)
    played, frame = np.zeros(len(voice) + RATE, np.float32), -1
    client = jack.Client("singer", servername=JACK, no_start_server=True)
    out, back = client.outports.register("out"), client.inports.register("in")

    @client.set_process_callback
    def process(frames: int) -> None:
        nonlocal frame
        block = out.get_array()
        block[:] = 0.0
        if 0 <= frame < len(voice):
            part = voice[frame : frame + frames]
            block[: len(part)] = part
            played[frame : frame + frames] = back.get_array()
            frame += frames

    client.activate()
    for here, there in (("singer:out", "yehu-server voice:in_0"), ("yehu-server:out_0", back)):
        deadline = time.monotonic() + 20.0
        while not client.get_ports(there if isinstance(there, str) else here):
            if time.monotonic() > deadline:
                sys.exit("there is nothing to sing to")
            time.sleep(0.05)
        client.connect(here, there)
    frame = 0
    while frame < len(voice):
        time.sleep(0.05)
    answer.send([latencies(played[start:], played[:start]) for start in starts])
    answer.close()
    os._exit(0)


def latencies(after: np.ndarray, before: np.ndarray) -> tuple[float, float]:
    """When a note is heard, and when it has half of its peak (ms); NaN where it is not."""
    note = np.abs(after[: int(NOTE_S * RATE)])
    floor = max(AUDIBLE * float(np.abs(before[-RATE // 50 :]).max()), LEAST)
    if note.max() < floor:
        return np.nan, np.nan
    return tuple(1e3 * int(np.argmax(note >= bar)) / RATE for bar in (floor, 0.5 * note.max()))


def measure(arguments: argparse.Namespace) -> dict[str, dict[str, Any]]:
    rows = {}
    for blocksize in BLOCKS:
        with dummy_jack(blocksize):
            playing = Playing(CARD, blocksize, "--follow", "--midi-api", "none")
            playing.said(r"following (\S+)")
            with helper(sing, arguments.notes) as singer:
                found = np.array(singer.recv())
            playing.end()
        heard = found[np.isfinite(found[:, 0])]
        row: dict[str, Any] = {"notes": len(found), "unheard": len(found) - len(heard)}
        for name, column in zip(("heard", "half"), heard.T, strict=True):
            least, median, most = np.quantile(column, (0.0, 0.5, 0.95))
            row |= {f"{name}, least": least, f"{name}, median": median, f"{name}, 95 %": most}
        rows[f"{blocksize} frames"] = row
    return rows


if __name__ == "__main__":
    report.run(__doc__, measure, notes=(20, "notes sung at each block size"))
