"""Which pitch an instrument is asked for, alone or in an ensemble."""

from __future__ import annotations

import numpy as np

from yehu_server.engine.instrument import Instrument
from yehu_server.engine.rig import RIG
from yehu_server.player.rows import BEND


def asked_pitch(instrument: Instrument) -> float | None:
    """Return the pitch of the sounding key with its bend (fractional MIDI note), if one sounds.

    Meters tell it too, but only those of an instrument that the callback plays.
    """
    player = np.frombuffer(instrument.memory, RIG, count=1)["player"][0]
    sounding = int(player["sounding"])
    return None if sounding < 0 else float(player["held_pitch"][sounding] + player["value"][BEND])
