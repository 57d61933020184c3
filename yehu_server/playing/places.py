"""Where the players of several parts sit on the stage, if nobody says otherwise."""

from __future__ import annotations

WIDEST = 0.7  # pan of the outermost players; by ear: the room stays around them


def places(parts: int) -> list[tuple[tuple[str, float], ...]]:
    """The start values of parameters, by address, that place each of some players.

    They sit side by side from left to right, in the order of the parts; one alone in the middle.
    """
    if parts == 1:
        return [()]
    step = 2.0 * WIDEST / (parts - 1)
    return [(("/room/pan", part * step - WIDEST),) for part in range(parts)]
