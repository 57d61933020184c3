"""No door makes another late: notes by MIDI, OSC and a page beside random mixes of all the rest.

The clock is that of frames (``bench/mixes.py``).
"""

import pytest
from mixes import failures, figures

HARD, SECONDS = (2, 5), 0.25  # mixes in which notes waited for longest, and panics end them
ALL = [pytest.param(mix, marks=pytest.mark.slow) for mix in range(1, 21) if mix not in HARD]


@pytest.mark.parametrize("mix", [0, *HARD, *ALL])
@pytest.mark.parametrize("block", [64, 128])
def test_a_note_by_any_door_is_late_by_less_than_a_block(block: int, mix: int) -> None:
    row = figures(mix, block, SECONDS, 1)
    assert [missed for missed in failures(row, block) if missed != "longest"] == []
    assert row["MIDI dropped"] == 0
