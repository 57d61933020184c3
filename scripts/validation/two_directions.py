"""Strings in two directions against one: beats, decay, the finger's share, least forces."""

import math
from typing import Any

import numpy as np

from yehu_lab.regimes.columns import HELMHOLTZ
from yehu_lab.sweeps.running import sweep
from yehu_lab.sweeps.study import study_of
from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.scores.gesture import gesture_from
from yehu_server.simulation.run import simulate

Floats = Any

RATE, SPEED, BETA = 44100.0, 0.2, 0.13
YEHU = Quantities()
BARE: dict[str, Any] = {"felt_loss": 0.0}
TWO = BARE | {"directions": "two"}
INSTRUMENTS: dict[str, dict[str, Any]] = {
    "one direction": BARE,
    "two": TWO,
    "two, no rocking": TWO | {"rocking": 0.0},
    "two, `R_s` = 30": TWO | {"finger": {"R_s": 30.0}},
}
SKINS: dict[str, dict[str, Any]] = {
    "one direction": BARE,
    "two, skin as assumed": TWO,
    "`R_s` = 30 kg/s": TWO | {"finger": {"R_s": 30.0}},
    "`R_s` = 100": TWO | {"finger": {"R_s": 100.0}},
    "`R_s` = 1.5, `K_s` = 1100 N/m": TWO | {"finger": {"R_s": 1.5, "K_s": 1100.0}},
}
# String, place of the finger (m), None for an open string.
NOTES: dict[str, tuple[int, float | None]] = {
    "A♯4, F4": (1, 0.0715),
    "C5, F4": (1, 0.094),
    "E5, F4": (1, 0.137),
    "C5, open": (2, None),
    "D5, C5": (2, 0.0345),
    "G5, C5": (2, 0.1),
}
C5 = NOTES["C5, F4"]
FORCES = np.geomspace(0.02, 1.2, 24)
BEGIN, HOLD, FALL = 0.6, 0.7, 0.667  # N, s, and s for a factor of e
LET_GO = 0.25  # s


def measure() -> dict[str, Any]:
    """All that validation.md says of two directions."""
    return {
        "beats": {name: beats(INSTRUMENTS[name]) for name in ("one direction", "two")},
        "slopes": {name: slopes(INSTRUMENTS[name]) for name in INSTRUMENTS if "R_s" not in name},
        "shares": {
            name: {str(press): finger_share(each, press) for press in (1.5, 3.0)}
            for name, each in SKINS.items()
        },
        "forces": {
            note: {name: forces(note, each) for name, each in INSTRUMENTS.items()} for note in NOTES
        },
        "rocking": rocking(),
    }


def run(controls: dict[str, Any], seconds: float, instrument: dict[str, Any], **more: Any) -> Any:
    """The signals of a gesture."""
    data = {"sample_rate": RATE, "duration": seconds, "instrument": instrument, **more}
    return simulate(gesture_from({**data, "controls": controls})).arrays


def fingered(place: float | None, press: float) -> dict[str, Any]:
    """The controls of the finger."""
    return {} if place is None else {"finger_position": place, "press_force": press}


def frequency(string: int, place: float | None) -> float:
    """Of an ideal string (Hz)."""
    own = YEHU.strings[string - 1]
    return math.sqrt(own.T / own.rho_A) / (2.0 * (YEHU.bridge_x - (place or 0.0)))


def plucked(
    string: int, place: float | None, press: float, instrument: dict[str, Any], energy: bool = False
) -> Any:
    """The signals of a string pulled along the bow, and let go at LET_GO."""
    sign = 1.0 if string == 1 else -1.0
    x = YEHU.bridge_x - BETA * (YEHU.bridge_x - (place or 0.0)) - 0.05
    pull = [[0.0, 0.0], [0.2, 0.5 * sign], [LET_GO, 0.5 * sign], [LET_GO, 0.0]]
    controls = {"pluck_force": pull, "pluck_position": x} | fingered(place, press)
    data = {"sample_rate": RATE, "duration": LET_GO + 0.7, "instrument": instrument}
    return simulate(gesture_from({**data, "controls": controls}), energy=energy).arrays


def let_go(arrays: Any, string: int) -> Floats:
    """The bridge's force (N) from then on."""
    return arrays[f"bridge_force_{string}"][round((LET_GO + 0.01) * RATE) :]


def first_partial(signal: Floats, f: float) -> tuple[Floats, Floats, float]:
    """Level (dB) of the first partial over time (s), and its frequency (Hz)."""
    n = 8 * len(signal)
    hertz = np.fft.rfftfreq(n, 1.0 / RATE)
    spectrum = np.abs(np.fft.rfft(signal - signal.mean(), n))
    f = hertz[np.where(np.abs(hertz / f - 1.0) < 0.08, spectrum, 0.0).argmax()]
    turned = signal * np.exp(-2j * np.pi * f * np.arange(len(signal)) / RATE)
    size = round(6.0 * RATE / f)
    window = np.hanning(size)
    starts = np.arange(0, len(signal) - size, size // 6)
    level = np.array([abs(window @ turned[at : at + size]) for at in starts])
    return starts / RATE, 20.0 * np.log10(level / level[0]), float(f)


def beats(instrument: dict[str, Any]) -> dict[str, Any]:
    """Levels (dB) of the open F4 string's first partial after some times (s)."""
    time, level, _ = first_partial(let_go(plucked(1, None, 0.0, instrument), 1), frequency(1, None))
    at = (0.0, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5)
    return {"time": at, "level": np.interp(at, time, level).tolist()}


def slopes(instrument: dict[str, Any]) -> tuple[float, float]:
    """Decay of a stopped C5 (dB/s) at first, and later."""
    time, level, _ = first_partial(let_go(plucked(*C5, 3.0, instrument), C5[0]), frequency(*C5))
    early, late = (time < 0.1) & (level > -60.0), (time > 0.12) & (time < 0.3) & (level > -80.0)
    return tuple(float(-np.polyfit(time[part], level[part], 1)[0]) for part in (early, late))  # type: ignore[return-value]


def finger_share(instrument: dict[str, Any], press: float) -> dict[str, float]:
    """R by the first slope (kg/s), and what share of the loss of C5 the finger has."""
    string, place = C5
    arrays = plucked(string, place, press, instrument, energy=True)
    time, level, f = first_partial(let_go(arrays, string), frequency(*C5))
    early = (time < 0.1) & (level > -60.0)
    alpha = -np.polyfit(time[early], level[early], 1)[0] * math.log(10.0) / 20.0
    own = YEHU.strings[string - 1]
    late = arrays["time"] > LET_GO + 0.005
    losses = {name: arrays[f"loss_{name}"][late].sum() for name in ("finger", "bridge", "strings")}
    share = losses["finger"] / sum(losses.values())
    return {"share": float(share), "R": 2.0 * f * math.sqrt(own.T * own.rho_A) / float(alpha)}


def forces(note: str, instrument: dict[str, Any]) -> dict[str, float]:
    """The least force (N) that keeps Helmholtz motion, and the least that starts it."""
    string, place = NOTES[note]
    sign = 1.0 if string == 1 else -1.0
    bow = YEHU.bridge_x - BETA * (YEHU.bridge_x - (place or 0.0))
    controls = {"bow_velocity": [[0.0, 0.0], [0.03, SPEED]], "bow_position": bow}
    controls |= fingered(place, 1.5)
    time = np.linspace(0.0, 4.0, 200)
    force = BEGIN * np.exp(-np.maximum(time - HOLD, 0.0) / FALL)
    ramp = {"bow_force": np.stack([time, sign * force], axis=1).tolist()}
    arrays = run(controls | ramp, 4.0, instrument)
    period = RATE / frequency(string, place)
    keep = kept(arrays["relative_velocity"], np.abs(arrays["bow_force"]), period)
    gesture = {"sample_rate": RATE, "duration": 0.5, "instrument": instrument, "controls": controls}
    study = study_of({"gesture": gesture, "vary": {"bow_force": (sign * FORCES).tolist()}})
    speaks = sweep(study).grid("regime") == HELMHOLTZ
    return {"keep": keep, "start": float(FORCES[speaks].min()) if speaks.any() else math.nan}


def kept(velocity: Floats, force: Floats, period: float) -> float:
    """The force (N) at which there begin to be more slips than one a period."""
    size, began = round(10.0 * period), False
    for at in range(round(0.35 * RATE), len(velocity) - size, size // 2):
        part = np.abs(velocity[at : at + size])
        slips = np.diff((part > 0.4 * part.max()).astype(int)) > 0
        count = slips.sum() / 10.0
        began = began or 0.85 <= count <= 1.15
        if began and count > 1.35:
            return float(force[at])
    return math.nan


def rocking() -> dict[str, dict[str, float]]:
    """Swing of a bowed C5's pitch (cents) and level (dB) under a finger that rocks."""
    found = {}
    string, place = C5
    bow = YEHU.bridge_x - BETA * (YEHU.bridge_x - (place or 0.0))
    controls = {"bow_velocity": [[0.0, 0.0], [0.03, SPEED]], "bow_position": bow, "bow_force": 0.5}
    for name in ("one direction", "two"):
        rock = {"rate": 6.0, "reach": 1e-3, "lean": 0.3, "start": 0.3}
        data = controls | fingered(place, 2.0)
        signal = run(data, 1.5, INSTRUMENTS[name], rocking=rock)["bridge_force_1"]
        signal = signal[round(0.5 * RATE) :]
        _, _, f = first_partial(signal, frequency(string, place))
        turned = signal * np.exp(-2j * np.pi * f * np.arange(len(signal)) / RATE)
        size = round(8.0 * RATE / f)
        smooth = np.convolve(turned, np.hanning(size), "valid")
        cents = 1200.0 / math.log(2.0) * np.diff(np.unwrap(np.angle(smooth))) * RATE
        cents /= 2.0 * np.pi * f
        level = 20.0 * np.log10(np.abs(smooth))
        found[name] = {
            "cents": float(np.ptp(np.percentile(cents, [5.0, 95.0]))),
            "db": float(np.ptp(np.percentile(level, [5.0, 95.0]))),
        }
    return found
