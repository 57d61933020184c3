"""No door makes another late: notes by MIDI, OSC and a page beside random mixes of all the rest.

The clock is that of frames (``bench/mixes.py``).
"""

from __future__ import annotations

import pytest
from mixes import OSC_KEYS, figures

HARD, SECONDS = (2, 17), 0.25  # mixes in which notes waited for longest
ALL = [pytest.param(mix, marks=pytest.mark.slow) for mix in range(1, 21) if mix not in HARD]


@pytest.mark.parametrize("mix", [0, *HARD, *ALL])
@pytest.mark.parametrize("block", [64, 128])
def test_a_note_by_any_door_is_late_by_less_than_a_block(block: int, mix: int) -> None:
    row = figures(mix, block, SECONDS, 1)
    late = {who: row[f"{who} late"] for who in ("MIDI", *OSC_KEYS, "page")}
    assert {who: frames for who, frames in late.items() if frames >= block} == {}
    assert row["MIDI lost"] == row["MIDI dropped"] == 0
