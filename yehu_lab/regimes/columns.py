"""What is found of a stroke: the regimes by number and name, and the columns of a sweep.

docs/sweep.md describes them; ``judge`` finds them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

# The hair is off the string; it moves hardly, or under a hair that slides steadily; one slip a
# period; several; one in a part of a period; it repeats after more than a period only; it does not
# repeat, with at most one slip a period; the same with more.
(UNBOWED, SILENT, HELMHOLTZ, MULTIPLE_SLIP, OCTAVE, ANOMALOUS_LOW, RAUCOUS, APERIODIC) = range(8)

REGIMES = (
    "unbowed", "silent", "helmholtz", "multiple slip", "octave", "anomalous low", "raucous",
    "aperiodic",
)  # fmt: skip

FINDING = np.dtype(
    [
        ("regime", np.uint8),
        ("faults", np.uint8),  # samples without a solution, and lost states; 255: or more
        ("slips", np.float32),  # in a period of the note
        ("certainty", np.float32),  # correlation at the period found
        ("first_slip_s", np.float32),  # from the beginning; NaN: none
        ("helmholtz_s", np.float32),  # from the beginning to lasting Helmholtz motion; NaN: never
        ("pitch_hz", np.float32),  # NaN: none
        ("level_db", np.float32),  # of the pressure, re 1 Pa (rms)
        ("brightness_hz", np.float32),  # spectral centroid, by power
    ],
    align=True,
)


@dataclass(frozen=True)
class Finding:
    """What was found of a stroke."""

    regime: str  # one of `REGIMES`
    slips: float  # in a period of the note, at the end
    # How alike the motion is to that a period before: 1 is the same. 0 where none is found.
    certainty: float
    # When the hair slips first, and from when it slips once a period (s); NaN for never.
    first_slip_s: float
    helmholtz_s: float
    pitch_hz: float  # NaN where the motion doesn't repeat
    level_db: float  # of the pressure at the end, re 1 Pa (rms)
    brightness_hz: float  # centroid of its spectrum, by power; NaN for silence

    @classmethod
    def of(cls, row: Any) -> Finding:
        """A record of dtype FINDING, for Python."""
        names = cls.__dataclass_fields__.keys() - {"regime"}
        return cls(REGIMES[int(row["regime"])], **{name: float(row[name]) for name in names})
