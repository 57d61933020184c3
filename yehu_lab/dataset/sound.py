"""One sound of a data set with all that is known of it, and how it is judged."""

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np

from yehu_lab.dataset.description import Description
from yehu_lab.regimes.columns import REGIMES, UNBOWED
from yehu_lab.regimes.judge import MIN_PERIODS, PERIODS, judge
from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.core.player.note_tables import NoteTables
from yehu_server.playing.calibration_store import calibration_for
from yehu_server.playing.tuning import STANDARD_A4

Array = Any

HOP_S = 0.02  # between two judgements of the regime
BOWED = 0.9  # share of what is judged in which the bow is on the string
STEADY_CENTS = 50.0  # by which the pitch asked for may move in what is judged


@dataclass(frozen=True)
class Sound:
    """A sound, and what the model was given and did for it."""

    # [shape=(frames,), float32] for strokes the pressure (Pa); for notes full scale is 1.
    audio: Array
    arrays: Mapping[str, Array]  # signals and controls at each sample, as of ``simulation.signals``
    drawn: Mapping[str, Any]  # what chance gave
    # `regime` (uint8), `regime_time` (s), and `asked_hz`, the pitch that is fingered then.
    found: Mapping[str, Array]
    faults: int  # number of samples without a solution, and of lost states
    # Of one stroke, as ``lab.regimes.judge.Finding`` has it: how it ends, and how it began.
    stroke: Mapping[str, Any] = field(default_factory=dict)

    @property
    def labels(self) -> dict[str, Any]:
        """What holds for the whole sound: its commonest regime, its last one, their shares."""
        regime = self.found["regime"]
        bowed = regime[regime != UNBOWED]
        counts = np.bincount(bowed, minlength=len(REGIMES))
        level = float(np.sqrt(np.mean(np.square(self.audio, dtype=np.float64))))
        return {
            "regime": REGIMES[int(counts.argmax())] if len(bowed) else REGIMES[UNBOWED],
            "last_regime": REGIMES[int(bowed[-1])] if len(bowed) else REGIMES[UNBOWED],
            "regime_shares": {
                name: round(int(count) / max(1, len(bowed)), 4)
                for name, count in zip(REGIMES, counts, strict=True)
                if count
            },
            "level_db": round(20.0 * math.log10(max(level, 1e-9)), 3),
            "faults": self.faults,
            **self.stroke,
        }


def regimes(
    arrays: Mapping[str, Array], asked_hz: Array, rate: float, lift_force: float
) -> dict[str, Array]:
    """Judge the regime every HOP_S, by the last periods before.

    Of signals and controls, and the pitch that is fingered [shape=(frames,)], NaN where none is,
    this is `Sound.found`. A bow of less than `lift_force` (N) is lifted.
    """
    frames = len(asked_hz)
    ends = np.arange(round(HOP_S * rate), frames + 1, round(HOP_S * rate))
    found = np.full(len(ends), UNBOWED, np.uint8)
    velocity, pressure = arrays["relative_velocity"], arrays["pressure"]
    bow, force = arrays["bow_velocity"], np.abs(arrays["bow_force"])
    for place, end in enumerate(ends):
        hertz = asked_hz[end - 1]
        if not hertz > 0.0:
            continue
        begin = max(0, end - math.ceil((PERIODS + 6) * rate / hertz))
        part = slice(begin, end)
        drift = np.abs(1200.0 * np.log2(asked_hz[part] / hertz))
        is_bowed = force[end - 1] >= lift_force and (force[part] >= lift_force).mean() > BOWED
        is_long = (end - begin) * hertz >= MIN_PERIODS * rate
        if not (is_bowed and is_long and drift.max() < STEADY_CENTS):
            continue
        judged = judge(velocity[part], bow[part], pressure[part], rate, float(hertz))
        found[place] = REGIMES.index(judged.regime)
    return {
        "regime": found,
        "regime_time": ends / rate,
        "asked_hz": asked_hz[ends - 1].astype(np.float32),
    }


def judged(arrays: Mapping[str, Array], hertz: float, rate: float) -> dict[str, Any]:
    """What a whole stroke is judged to be, None where there is no number; see `Finding`."""
    signals = (arrays["relative_velocity"], arrays["bow_velocity"], arrays["pressure"])
    found = asdict(judge(*signals, rate, hertz))
    found["last_regime"] = found.pop("regime")
    found["end_level_db"] = found.pop("level_db")
    for name, value in found.items():
        if not isinstance(value, str):
            found[name] = float(f"{value:.6g}") if math.isfinite(value) else None
    return found


_calibrated: dict[str, tuple[Quantities, NoteTables]] = {}  # of this process


def calibrated(description: Description) -> tuple[Quantities, NoteTables]:
    """The instrument of a description, tuned to F4 and C5; and how it was."""
    key = description.key
    if key not in _calibrated:
        calibration = calibration_for(description.rate, description.quantities, a4=STANDARD_A4)
        _calibrated[key] = calibration.tuned(description.quantities), calibration
    return _calibrated[key]
