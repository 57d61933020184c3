"""What the player does all the time, every 5 ms: holds its hands, minds the bow, listens."""

from __future__ import annotations

from typing import Any

import numpy as np

from yehu_server.controls.record import CONTROLS
from yehu_server.jit import native
from yehu_server.memory import carray
from yehu_server.player.drift import sway, sway_vibrato
from yehu_server.player.ear import HEARD
from yehu_server.player.listening import listen
from yehu_server.player.notes import mind_the_bow
from yehu_server.player.record import PLAYER


@native("void(voidptr, voidptr, voidptr)")
def attend(player: Any, controls: Any, sound: Any) -> None:
    """Do what is to be done at the frames of ``ear.next``.

    Parameters
    ----------
    player : pointer to a record of dtype PLAYER
    controls : pointer to a record of dtype CONTROLS
    sound : pointer to what `ear.remember` keeps

    Real time: safe.
    """
    p = carray(player, (1,), PLAYER)[0]
    c = carray(controls, (1,), CONTROLS)[0]
    p.ear.next += p.ear.hop
    sway(p, c)
    sway_vibrato(p, c)
    mind_the_bow(p, c)
    listen(p, c, carray(sound, (2 * HEARD,), np.float64))
