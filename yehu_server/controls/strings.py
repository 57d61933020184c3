"""Tuning and loss of the strings while they sound. Compiled."""

from __future__ import annotations

from typing import Any

from yehu_server.controls.slots import LOSS, TUNING
from yehu_server.jit import compiled
from yehu_server.physics.layout import STRINGS


@compiled
def has_new_strings(c: Any) -> bool:
    """Whether the tuning or loss of a string differs from what the model has."""
    for i in range(STRINGS):
        if c.value[TUNING[i]] != c.tuning[i] or c.value[LOSS[i]] != c.loss[i]:
            return True
    return False
