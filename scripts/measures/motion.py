"""How much a note moves once it has begun, and what is between notes: figures of any sound.

A note is a run of frames that stay within NEAR semitones of its median pitch. Over the middle 60 %
of notes of 0.5 s or more: standard deviations of each of the first eight partials beside the sum of
them (the median of those within 30 dB of the strongest), of the level, and of the pitch; and over
all of each, the swell: its loudest 0.1 s above the median of its first 0.15 s. A note is plain
where its pitch swings by less than PLAIN_CENTS at 4 to 9 Hz; the drift is what a mean over SLOW_S
leaves.
"""

from itertools import pairwise
from typing import Any

import numpy as np

from measures.heard import HOP_S, Track, heard

Array = Any

NEAR, MAX_GAP, RECENT = 0.75, 6, 60  # semitones; frames without a pitch; frames of the median
SILENT_DB = 38.0  # below the loudest moment of all
LONG_S, SHORT_S = 0.5, 0.12  # of notes that are judged within; of those between which it is judged
WINDOW_S, PARTIALS, WEAK_DB = 0.04, 8, 30.0
VIBRATO_HZ, PLAIN_CENTS, SLOW_S = (4.0, 9.0), 4.0, 0.4
APART_S, NEAR_EITHER = 0.15, 0.2  # between notes that follow; share of the step
DIP_S, BESIDE_S, SLOW_STEP_S = 0.08, 0.2, 0.06

Runs = list[tuple[int, int]]


def runs_of(track: Track) -> Runs:
    """The first frame of each note, and the one after its last."""
    is_loud = track.level_db > track.level_db.max() - SILENT_DB
    pitch = np.where(is_loud, track.pitch, np.nan)
    runs, begin = [], 0
    while begin < len(pitch):
        if not np.isfinite(pitch[begin]):
            begin += 1
            continue
        at, gap, seen = begin, 0, [pitch[begin]]
        while at < len(pitch) and gap <= MAX_GAP:
            is_like = abs(pitch[at] - np.median(seen[-RECENT:])) < NEAR  # not where it is NaN
            if is_like:
                seen.append(pitch[at])
            gap = 0 if is_like else gap + 1
            at += 1
        end = at - gap
        if end - begin >= SHORT_S / HOP_S:
            runs.append((begin, end))
        begin = max(end, begin + 1)
    return runs


def partials_db(sound: Array, rate: float, pitch: Array, frames: Array) -> Array:
    """Levels (dB) of the first partials at frames whose pitches are known: (frames, PARTIALS)."""
    size = round(WINDOW_S * rate)
    time = np.arange(size) / rate - WINDOW_S / 2.0
    window, orders = np.hanning(size), np.arange(1, PARTIALS + 1)
    rows = []
    for frame, note in zip(frames, pitch, strict=True):
        begin = round(frame * HOP_S * rate) - size // 2
        part = sound[begin : begin + size]
        if begin < 0 or len(part) < size:
            continue
        hz = 440.0 * 2.0 ** ((note - 69.0) / 12.0)
        waves = np.exp(-2j * np.pi * hz * np.outer(orders, time))
        rows.append(np.abs(waves @ (part * window)))
    return 20.0 * np.log10(np.array(rows) + 1e-9)


def of_note(sound: Array, rate: float, track: Track, run: tuple[int, int]) -> dict[str, float]:
    """The figures of one note."""
    begin, end = run
    whole = track.part(begin * HOP_S, end * HOP_S)
    known = np.flatnonzero(np.isfinite(whole.pitch))
    pitch = np.interp(np.arange(end - begin), known, whole.pitch[known])
    edge = round(0.2 * (end - begin))
    inner = np.arange(edge, end - begin - edge)
    levels = partials_db(sound, rate, pitch[inner[::2]], begin + inner[::2])
    total = 10.0 * np.log10((10.0 ** (levels / 10.0)).sum(1))
    is_strong = levels.mean(0) > levels.mean(0).max() - WEAK_DB
    middle = 100.0 * pitch[inner]
    power = np.abs(np.fft.rfft((middle - middle.mean()) * np.hanning(len(middle)))) ** 2
    hz = np.fft.rfftfreq(len(middle), HOP_S)
    shaking = power[(hz >= VIBRATO_HZ[0]) & (hz <= VIBRATO_HZ[1])].sum()
    swings = np.sqrt(2.0 * shaking / np.square(np.hanning(len(middle))).sum() / len(middle))
    slow = np.hanning(round(SLOW_S / HOP_S) + 1)
    padded = np.pad(100.0 * pitch, len(slow) // 2, "reflect")
    smooth = np.convolve(padded, slow / slow.sum(), "valid")[inner]
    level = np.convolve(whole.level_db, np.full(20, 0.05), "valid")
    return {
        "partials": float(np.median((levels[:, is_strong] - total[:, None]).std(0))),
        "level": float(total.std()),
        "swell": float(level.max() - np.median(whole.level_db[:30])),
        "pitch": float(middle.std()),
        "swings": float(swings),
        "drift": float(smooth.std()),
        "off": float(np.median(middle) - 100.0 * np.rint(np.median(middle) / 100.0)),
    }


def between(track: Track, runs: Runs) -> tuple[list[float], list[float]]:
    """Times (s) of the steps between notes that follow, and the dips of the level there (dB)."""
    times, dips = [], []
    few, some = round(DIP_S / HOP_S), round(BESIDE_S / HOP_S)
    for (begin, end), (start, stop) in pairwise(runs):
        if start - end > APART_S / HOP_S:
            continue
        level = track.level_db
        beside = (
            np.median(level[max(begin, end - some) : end]),
            np.median(level[start : min(stop, start + some)]),
        )
        dips.append(float(min(beside) - level[max(end - few, begin) : start + few].min()))
        old, new = np.nanmedian(track.pitch[begin:end]), np.nanmedian(track.pitch[start:stop])
        if not 0.7 < abs(new - old) < 12.5:
            continue
        path = track.pitch[max(begin, end - 2 * some) : min(stop, start + 2 * some)]
        share = (path - old) / (new - old)
        middle = min(end, stop) - max(begin, end - 2 * some)
        left = np.flatnonzero(share[: middle + 1] < NEAR_EITHER)
        there = np.flatnonzero(share > 1.0 - NEAR_EITHER)
        there = there[there > (left[-1] if len(left) else 0)]
        if not (len(left) and len(there)):
            continue
        way = share[left[-1] : there[0]]
        times.append(HOP_S * len(way) if np.isfinite(way).mean() > 0.6 else 0.0)
    return times, dips


def motion(sound: Array, rate: float) -> dict[str, float]:
    """The figures of a sound of one voice, ndarray [shape=(samples,)] at a rate (Hz).

    Medians over notes of `partials`, `level`, `swell` (dB), `drift` (cents); of notes without a
    vibrato `pitch` (cents), and `off`, the amount of their distance from the nearest key; `steps`,
    the share of steps longer than 60 ms; `dip`, the 90th of a hundred (dB); `dynamics`, 5 to 95 of
    a hundred of the level (dB). NaN where there are no such notes.
    """
    sound = np.asarray(sound, np.float64)
    track = heard(sound, rate)
    runs = runs_of(track)
    long = [run for run in runs if run[1] - run[0] >= LONG_S / HOP_S]
    notes = [of_note(sound, rate, track, run) for run in long]
    plain = [note for note in notes if note["swings"] < PLAIN_CENTS]
    times, dips = between(track, runs)
    loud = track.level_db[track.level_db > track.level_db.max() - 35.0]

    def median(name: str, of: list[dict[str, float]]) -> float:
        return float(np.median([abs(note[name]) for note in of])) if of else float("nan")

    return {
        **{name: median(name, notes) for name in ("partials", "level", "swell")},
        **{name: median(name, plain) for name in ("pitch", "off")},
        "drift": median("drift", notes),
        "steps": float(np.mean(np.array(times) > SLOW_STEP_S)) if times else float("nan"),
        "dip": float(np.quantile(dips, 0.9)) if dips else float("nan"),
        "dynamics": float(np.ptp(np.quantile(loud, (0.05, 0.95)))),
        "notes": float(len(notes)),
    }
