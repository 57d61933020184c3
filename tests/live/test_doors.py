"""No door makes another late: notes by MIDI, OSC and a page beside random mixes of all the rest.

The clock is that of frames (``bench/mixes.py``).
"""

import numpy as np
import pytest
from mixes import Sender, Stage, failures, figures

from yehu_server.core.engine.mailbox import SENDER_QUEUES
from yehu_server.core.player.commands import BEGIN
from yehu_server.live.osc.packets import pack

HARD, SECONDS = (2, 5), 0.25  # mixes in which notes waited for longest, and panics end them
ALL = [pytest.param(mix, marks=pytest.mark.slow) for mix in range(1, 21) if mix not in HARD]


@pytest.mark.parametrize("mix", [0, *HARD, *ALL])
@pytest.mark.parametrize("block", [64, 128])
def test_a_note_by_any_door_is_late_by_less_than_a_block(block: int, mix: int) -> None:
    row = figures(mix, block, SECONDS, 1)
    assert [missed for missed in failures(row, block) if missed != "longest"] == []
    assert row["MIDI dropped"] == 0


def test_a_sender_that_comes_after_many_that_flood_loses_no_note() -> None:
    stage, flooding = Stage(0), [Sender(has_connection=False) for _ in range(SENDER_QUEUES + 10)]
    honest, block, asked = Sender(has_connection=False), 64, {}
    out = np.zeros((block, 2), np.float32)
    stage.instrument.report_commands()
    for n in range(200):
        frame = stage.ensemble.frame
        for sender in flooding:
            for key in range(4):
                sender.play(stage.handler, [pack("/yehu/note", float(key), 90.0)], frame)
        if n >= 100 and n % 10 == 0:
            asked[60.0 + n // 10] = frame
            honest.play(stage.handler, [pack("/yehu/note", 60.0 + n // 10, 90.0)], frame)
        stage.ensemble.process(out)
    applied = stage.instrument.applied_commands()
    begun = applied[(applied["kind"] == BEGIN) & (applied["value"] >= min(asked))]
    assert stage.instrument.dropped_events > 0
    assert begun["value"].tolist() == [*asked]
    assert (begun["frame"] - [*asked.values()] < block).all()
