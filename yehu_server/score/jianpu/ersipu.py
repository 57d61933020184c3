"""Reads 二四谱, the notation of Chaozhou: jianpu with characters in place of figures."""

from __future__ import annotations

import os

from yehu_server.score.jianpu.reader import read_jianpu
from yehu_server.score.written.notated import Written


def read_ersipu(path: str | os.PathLike[str]) -> Written:
    """Read a file of 二四谱, which is in F where no key is written.

    Raises
    ------
    ScoreError
        As `read_jianpu`.
    """
    return read_jianpu(path)
