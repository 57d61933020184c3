"""Wait for other threads and processes."""

import time
from collections.abc import Callable
from typing import Any

PATIENCE_S, LONG_S = 20.0, 120.0  # on a busy machine; for processes that load much


def until(
    condition: Callable[[], Any], what: str = "it to be so", within_s: float = PATIENCE_S
) -> Any:
    """Wait for something to be true, and return it."""
    deadline = time.monotonic() + within_s
    while not (value := condition()):
        assert time.monotonic() < deadline, f"not within {within_s} s: {what}"
        time.sleep(0.002)
    return value
