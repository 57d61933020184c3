"""Compiles what playing or simulating needs, and says so where that takes long."""

from __future__ import annotations

import logging

from yehu_server.jit import IS_PLAIN, cache_folder

log = logging.getLogger("yehu_server")


def get_ready(*, plays: bool) -> None:
    """Warn, by `logging`, where the model will be compiled; compile what playing needs.

    Parameters
    ----------
    plays : bool
        Whether the instrument is played; the model alone is compiled at its first use.
    """
    if not IS_PLAIN and not any(cache_folder().glob("*.code")):
        log.warning("compiling the model for this machine, once; it takes up to a minute")
    if plays:
        from yehu_server.engine.warming import warm_up

        warm_up()
