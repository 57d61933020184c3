"""How well and how soon a voice is followed as it sings: `serve --follow`, and the page.

    .venv/bin/python bench/following_live.py [--notes 20] --save bench/results/following_live.json

What is heard: the sounds of bench/following.py, and more instruments of the bank, plain and with
noise. Time is that of the sound, in blocks of 128 samples: an audio device adds its own. Attacks of
the bank's instruments, some of which are slow, count as lateness.

How soon: a JACK client in another process sings to `serve --follow` over JACK's dummy driver, and
records what is played, both by the frames of its own callback. Chromium has the same song as its
microphone, and the page's AudioContext is recorded: what comes in, and what goes out. Of each note,
the times from its first sample to when the follower begins to bow (the same song followed in this
process); to the first sample that is heard, 20 dB over the rest before; and to the first at half of
the note's peak. Devices add what their buffers hold, and so do browsers, by their own report.
"""

from __future__ import annotations

import json
import math
import os
import shutil
import subprocess
import tempfile
import threading
import time
from pathlib import Path
from typing import Any

import numpy as np
import report
import soundfile
from endurance import Playing
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
from load import CARD, JACK, dummy_jack, helper

from yehu_server.core.engine.voice_callback import (
    COMMAND_NUMBERS,
    follow_voice,
    voice_pitch,
    voice_prepare,
)
from yehu_server.core.engine.warming import warm_up
from yehu_server.core.player.commands import BEGIN
from yehu_server.core.voice.note_detection import FOLLOWER
from yehu_server.live.page.site import server_of, url_of, write_page

Array = Any

MORE = {"oboe": 68, "clarinet": 71, "saxophone": 65, "cello": 42, "horn": 60, "choir": 52}
HEARD_WITH = ("plain", "noise, 20 dB")
BLOCK, ROOM = 128, 64  # samples; commands
OCTAVE_CENTS, SEMITONE_CENTS = 1200.0, 100.0
LATEST_S, STEP_S = 0.08, 0.0025  # of what is heard after what was sung

JACK_RATE, PERIODS = 48000, (64, 128, 256)
PITCHES = (65.0, 67.0, 69.0, 70.0, 72.0)  # that are sung in turn, from F4
NOTE_S, REST_S, ATTACK_S = 0.5, 0.7, 0.015
AUDIBLE, LEAST = 10.0, 1e-5  # times the rest before; of full scale
BEGUN = 0.003  # of the song's peak: its notes begin with less
WORKLET = 128  # frames
HERE = Path(__file__).parent


def followed(sound: Array, rate: float = RATE, size: int = BLOCK) -> tuple[Array, Array, Array]:
    """The times of blocks, the pitch that is followed after each (NaN: none), and the onsets."""
    voice, commands = np.zeros(1, FOLLOWER), np.zeros((ROOM, COMMAND_NUMBERS))
    voice_prepare.call(voice.ctypes.data, float(rate), math.nan, 0.0)
    sound = np.ascontiguousarray(sound, np.float32)
    ends = np.arange(size, len(sound), size)
    pitch, onsets = [], []
    for end in ends:
        block = sound[end - size : end]
        count = follow_voice.call(
            voice.ctypes.data, block.ctypes.data, size, commands.ctypes.data, ROOM
        )
        onsets += [end / rate] * int((commands[:count, 0] == BEGIN).sum())
        pitch.append(voice_pitch.call(voice.ctypes.data))
    return ends / rate, np.array(pitch), np.array(onsets)


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


def heard() -> dict[str, dict[str, float]]:
    rows = {}
    more = {name: (of_bank(program), 0.0) for name, program in MORE.items()}
    for name, (sound, shift) in (sounds() | more).items():
        scaled = 0.3 * sound / np.abs(sound).max()
        for condition in HEARD_WITH:
            rows[f"{name}, {condition}"] = judged(CONDITIONS[condition](scaled), shift)
    return rows


# ---------------------------------------------------------------- how soon


def song(notes: int) -> tuple[Array, Array]:
    """Sung notes with rests between them, and the frames at which they begin."""
    time_s = np.arange(int(NOTE_S * JACK_RATE)) / JACK_RATE
    fade = np.clip(np.minimum(time_s, time_s[::-1]) / ATTACK_S, 0.0, 1.0)
    rest = np.zeros(int(REST_S * JACK_RATE))
    parts, starts = [rest, rest], []
    for number in range(notes):
        hz = 440.0 * 2.0 ** ((PITCHES[number % len(PITCHES)] - 69.0) / 12.0)
        starts.append(sum(map(len, parts)))
        voice = sum(np.sin(2.0 * np.pi * k * hz * time_s) / k for k in range(1, 13))
        # Where in a hop of the follower a note begins is left to chance.
        parts += [0.1 * fade * voice, rest, np.zeros(97 * number % 240)]
    return np.concatenate(parts).astype(np.float32), np.array(starts)


def sing(notes: int, answer: Any) -> None:
    """Sing, and answer with what was played meanwhile."""
    import jack

    for silence in (jack.set_error_function, jack.set_info_function):
        silence(lambda _message: None)
    voice, _ = song(notes)
    played, frame = np.zeros(len(voice) + JACK_RATE, np.float32), -1
    client = jack.Client("singer", servername=JACK, no_start_server=True)
    out, back = client.outports.register("out"), client.inports.register("in")

    @client.set_process_callback  # type: ignore[untyped-decorator]
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
    client.connect(out, "yehu-server voice:in_0")
    client.connect("yehu-server:out_0", back)
    frame = 0
    while frame < len(voice):
        time.sleep(0.05)
    answer.send(played)
    os._exit(0)


def latencies(after: Array, before: Array, rate: float) -> tuple[float, float]:
    """When a note is heard, and when it has half of its peak (ms); NaN where it is not."""
    note = np.abs(after[: int(NOTE_S * rate)])
    floor = max(AUDIBLE * float(np.abs(before[-int(0.02 * rate) :]).max()), LEAST)
    if note.max() < floor:
        return math.nan, math.nan
    first, half = (int(np.argmax(note >= bar)) for bar in (floor, 0.5 * note.max()))
    return 1e3 * first / rate, 1e3 * half / rate


def sing_to_page(voice: Array) -> tuple[dict[str, Any], Array, Array]:
    """Sing to the page; what its browser reports, and what it was given and played."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_page(folder / "site")
        server = server_of(folder / "site", 0)
        threading.Thread(target=server.serve_forever, daemon=True).start()
        soundfile.write(folder / "song.wav", voice, JACK_RATE, subtype="PCM_16")
        words = [url_of(server), str(shutil.which("chromium")), str(folder / "song.wav")]
        words += [str(len(voice) / JACK_RATE), str(folder / "recorded")]
        done = subprocess.run(  # noqa: S603 - our own command
            [str(shutil.which("node")), HERE / "following_page.mjs", *words],
            check=True,
            capture_output=True,
        )
        server.shutdown()
        given, played = np.fromfile(folder / "recorded", np.float32).reshape(-1, 2).T
    return json.loads(done.stdout), given, played


def row_of(voice: Array, starts: Array, played: Array, rate: float, period: int) -> dict[str, Any]:
    """A row of the table: of notes that begin at these frames, as they are sung and played."""
    _, _, onsets = followed(voice, rate, period)
    bowed = 1e3 * (onsets[np.searchsorted(onsets, starts / rate)] - starts / rate)
    found = np.array([latencies(played[start:], played[:start], rate) for start in starts])
    row: dict[str, Any] = {"notes": len(starts), "unheard": int(np.isnan(found[:, 0]).sum())}
    for name, column in {"bow": bowed, "heard": found[:, 0], "half": found[:, 1]}.items():
        middle, most = np.nanquantile(column, (0.5, 0.95))
        row |= {f"{name}, median": float(middle), f"{name}, 95 %": float(most)}
    return row


def soon(notes: int) -> dict[str, dict[str, Any]]:
    rows = {}
    voice, starts = song(notes)
    reported, given, played = sing_to_page(voice)
    loud = np.flatnonzero(np.abs(given) > BEGUN * np.abs(given).max())
    begun = loud[np.diff(loud, prepend=-RATE) > 0.5 * REST_S * reported["rate"]]
    rows["page"] = row_of(given, begun, played, reported["rate"], WORKLET)
    rows["page"] |= {f"browser's {name}": 1e3 * reported[name] for name in ("input", "output")}
    for period in PERIODS:
        with dummy_jack(period, JACK_RATE, "--sync"):  # late programs are waited for
            playing = Playing(CARD, period, "--follow", "--midi-api", "none", "--no-panel")
            playing.said(r"following (\S+)")
            with helper(sing, notes) as singer:
                played = singer.recv()
            playing.end()
        rows[f"{period} frames"] = row_of(voice, starts, played, JACK_RATE, period)
    return rows


def main() -> None:
    """Measure and print everything."""
    parser = report.options(__doc__ or "")
    parser.add_argument("--notes", type=int, default=20, help="sung at each period (default: 20)")
    arguments = parser.parse_args()
    warm_up()  # compile before processes wait for each other
    figures = {"soon": soon(arguments.notes), "heard": heard()}
    for name, rows in figures.items():
        report.show(rows, name)
    report.save(arguments.save, figures, notes=arguments.notes, device=report.NO_CARD)


if __name__ == "__main__":
    main()
