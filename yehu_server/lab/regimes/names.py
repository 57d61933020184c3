"""The regimes of a bowed string, by number and name; docs/sweep.md defines them."""

from __future__ import annotations

# The hair is off the string; it moves hardly, or under a hair that slides steadily; one slip a
# period; several; one in a part of a period; it repeats after more than a period only; it does not
# repeat, with at most one slip a period; the same with more.
(UNBOWED, SILENT, HELMHOLTZ, MULTIPLE_SLIP, OCTAVE, ANOMALOUS_LOW, RAUCOUS, APERIODIC) = range(8)

REGIMES = (
    "unbowed",
    "silent",
    "helmholtz",
    "multiple slip",
    "octave",
    "anomalous low",
    "raucous",
    "aperiodic",
)
