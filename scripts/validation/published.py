"""The scale that the authors of [Yehu] published, beside ours.

Their sounds are no part of this project. `measure` reads `SCALE` from a folder that has it, from
the site that [Yehu] names: eight steady notes, F4 to F5, of 1.25 s, four on each string.
Each note is bowed here at its pitch, and the levels of harmonics are compared, twice: as our
filter radiates them, and by one common filter, that no file of theirs names. What that filter does
to a note is taken from the seven others alone, by frequency; so it can only explain what a
harmonic's frequency explains.
"""

import math
from pathlib import Path
from typing import Any

import numpy as np

from yehu_server.scores.gesture import gesture_from
from yehu_server.simulation.run import simulate

Floats = np.ndarray[Any, np.dtype[np.float64]]

SCALE = "pena_scale.wav"
RATE, EACH_S = 44100, 1.25
STEADY_S = (0.6, 1.1)  # of each note
HARMONICS = 10
# String, pitch (Hz), and the finger (m) that makes it here; None for an open string.
NOTES: tuple[tuple[int, float, float | None], ...] = (
    (1, 352.57, None),
    (1, 393.33, 0.02977),
    (1, 444.66, 0.05645),
    (1, 475.60, 0.07230),
    (2, 525.48, None),
    (2, 586.12, 0.03054),
    (2, 655.62, 0.05733),
    (2, 701.39, 0.07312),
)
# Their bridge at 0.30 m rounded down to a node: 0.2956 m of string 1, 0.2947 m of string 2.
PAPERS: dict[str, Any] = {"base": "paper", "bridge_x": 0.295}
GESTURE = {"force": 0.5, "speed": 0.2, "place": 0.255, "press": 0.5}
# What is changed, one at a time: of the gesture, and of the instrument.
CHANGES: dict[str, tuple[dict[str, float], dict[str, Any]]] = {
    "as in the paper": ({}, {}),
    "force 0.7 N": ({"force": 0.7}, {}),
    "force 1 N": ({"force": 1.0}, {}),
    "speed 0.15 m/s": ({"speed": 0.15}, {}),
    "bow 5 mm farther from the bridge": ({"place": 0.25}, {}),
    "bow 20 mm farther": ({"place": 0.235}, {}),
    "press 0.3 N": ({"press": 0.3}, {}),
    "press 3 N": ({"press": 3.0}, {}),
    "bristles ten times as stiff": ({}, {"bow": {"epsilon_0": 3.186e5}}),
    "ξ 0.4 on both strings": ({}, {"bow": {"xi": [0.4, 0.4]}}),
    "felt": ({}, {"felt_loss": 300.0}),
    "torsion": ({}, {"torsion": "on"}),
    "modal strings": ({}, {"scheme": "modal"}),
}
SIGNALS = ("pressure", "bridge_force", "bridge_velocity", "displacement")
BROAD = 1.0 / 12.0  # octaves: over so much the common filter is taken for even
SEARCH = 0.04  # about a note's pitch


def measure(folder: Path) -> dict[str, Any]:
    """How far each change is from theirs, and how far each signal."""
    pairs = zip(scale(folder), NOTES, strict=True)
    theirs = np.array([levels(sound, hertz) for sound, (_, hertz, _) in pairs])
    rows = []
    for name, (gesture, instrument) in CHANGES.items():
        signals = ours(gesture, instrument)
        found = compared(theirs, signals["pressure"], signals["bridge_force"])
        rows.append({"changed": name} | found)
    plain = ours({}, {})
    sawtooth = -20.0 * np.log10(np.arange(1, HARMONICS + 1))
    return {
        "changes": rows,
        "signals": {each: off_by_gain(theirs - plain[each]) for each in SIGNALS},
        "sawtooth": size(beside_common_filter(theirs - sawtooth)),
        "filtered": (theirs - plain["bridge_force"]).tolist(),  # what their filter does
    }


def scale(folder: Path) -> list[Floats]:
    """Their eight notes."""
    import soundfile

    sound, rate = soundfile.read(folder / SCALE)
    if rate != RATE:
        raise SystemExit(f"{folder / SCALE}: expected {RATE} Hz, got {rate}")
    starts = [(EACH_S * note + STEADY_S[0], EACH_S * note + STEADY_S[1]) for note in range(8)]
    return [sound[round(begin * RATE) : round(end * RATE)] for begin, end in starts]


def ours(gesture: dict[str, float], instrument: dict[str, Any]) -> dict[str, Floats]:
    """Levels (dB) of harmonics [shape=(notes, HARMONICS)] of each of SIGNALS."""
    g = GESTURE | gesture
    found: dict[str, list[Floats]] = {each: [] for each in SIGNALS}
    for string, hertz, finger in NOTES:
        controls: dict[str, Any] = {
            "bow_force": [[0.0, 0.0], [0.02, g["force"] if string == 1 else -g["force"]]],
            "bow_velocity": [[0.0, 0.0], [0.03, g["speed"]]],
            "bow_position": g["place"],
        }
        if finger is not None:
            press = [[0.0, 0.0], [0.01, g["press"]]]
            controls |= {"finger_position": finger, "press_force": press}
        data = {"sample_rate": RATE, "duration": 1.0, "instrument": PAPERS | instrument}
        arrays = dict(simulate(gesture_from(data | {"controls": controls})).arrays)
        arrays["displacement"] = np.cumsum(arrays["bridge_velocity"]) / RATE
        for each in SIGNALS:
            found[each].append(levels(arrays[each][RATE // 2 :], hertz))
    return {each: np.array(rows) for each, rows in found.items()}


def levels(sound: Floats, near: float) -> Floats:
    """Levels (dB) of the harmonics of a steady sound, whose pitch is near `near` Hz."""
    size_ = len(sound)
    window = np.hanning(size_)
    spectrum = np.abs(np.fft.rfft(sound * window, 16 * size_))
    hertz = np.fft.rfftfreq(16 * size_, 1.0 / RATE)
    pitch = hertz[np.where(np.abs(hertz / near - 1.0) < SEARCH, spectrum, 0.0).argmax()]
    time = np.arange(size_) / RATE
    turns = np.exp(-2j * math.pi * pitch * np.outer(np.arange(1, HARMONICS + 1), time))
    amplitudes = np.abs(turns @ (sound * window)) * 2.0 / window.sum()
    return np.asarray(20.0 * np.log10(amplitudes + 1e-12))


def beside_common_filter(difference: Floats) -> Floats:
    """What is left of differences (dB) of notes when one filter, unknown, made all of them.

    NaN where no harmonic of another note is near enough to tell.
    """
    place = np.log2(np.outer([hertz for _, hertz, _ in NOTES], np.arange(1, HARMONICS + 1)))
    left = np.full(difference.shape, np.nan)
    for note in range(len(NOTES)):
        others = np.arange(len(NOTES)) != note
        away = np.abs(place[others].ravel() - place[note][:, np.newaxis]) / BROAD
        weight = np.where(away < 2.0, np.exp(-0.5 * away**2), 0.0)
        known = (weight > 0.0).sum(axis=1) >= 2
        filtered = weight @ difference[others].ravel() / np.maximum(weight.sum(axis=1), 1e-12)
        left[note] = np.where(known, difference[note] - filtered, np.nan)
    return left


def compared(theirs: Floats, pressure: Floats, force: Floats) -> dict[str, float]:
    """How far ours is: rms and median of harmonics (dB), and the notes' levels."""
    loud = [10.0 * np.log10((10.0 ** (each / 10.0)).sum(axis=1)) for each in (theirs, pressure)]
    common = beside_common_filter(theirs - force)
    return {
        "r": float(np.corrcoef(*loud)[0, 1]),
        "own": off_by_gain((theirs - pressure)[np.isfinite(common)]),
        "common": size(common)["rms"],
        "common_median": size(common)["median"],
    }


def off_by_gain(difference: Floats) -> float:
    """The rms of differences (dB) but for one gain."""
    return float(np.sqrt(np.mean((difference - np.median(difference)) ** 2)))


def size(left: Floats) -> dict[str, float]:
    """The rms and the median of the absolute values (dB)."""
    return {"rms": float(np.sqrt(np.nanmean(left**2))), "median": float(np.nanmedian(np.abs(left)))}
