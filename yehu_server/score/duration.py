"""How long a score may last."""

from __future__ import annotations

from yehu_server.errors import ScoreError

MAX_DURATION_H = 2.0  # of all that is played, where no other is asked for
LONGEST_DURATION_H = 1000.0  # that may be asked for


def check_duration(seconds: float, max_duration_h: float, what: str = "the score lasts") -> None:
    """Raise ScoreError where a score lasts longer than so many hours."""
    hours = seconds / 3600.0
    if hours > max_duration_h:
        raise ScoreError(
            f"{what} {hours:.3g} hours, more than {max_duration_h:g}: see --max-duration"
        )
