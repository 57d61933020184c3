"""What playing needs is compiled in two processes, and kept."""

from __future__ import annotations

import os
import subprocess
import sys
from functools import cache

import pytest

from yehu_server.compile.jit import Native
from yehu_server.core.engine import warming
from yehu_server.core.engine.sounding import sound
from yehu_server.util.processes import python_command


def beginnings(monkeypatch) -> list[list[str]]:
    """The command lines of processes that would be started from now on."""
    begun: list[list[str]] = []

    class Beside:
        def __init__(self, command: list[str], **_: object) -> None:
            begun.append(command)

        def wait(self) -> int:
            return 0

        kill = wait

    monkeypatch.setattr(warming.subprocess, "Popen", Beside)
    monkeypatch.setattr(warming.os, "cpu_count", lambda: 2)
    return begun


def test_no_process_is_started_when_all_is_kept(monkeypatch):
    warming.warm_up()
    assert warming.is_warm()
    begun = beginnings(monkeypatch)
    warming.warm_up()
    assert begun == []


@pytest.mark.parametrize("processors", [2, 1])
def test_the_model_is_compiled_beside_where_there_is_a_second_processor(monkeypatch, processors):
    warming.warm_up()
    begun = beginnings(monkeypatch)
    monkeypatch.setattr(warming.os, "cpu_count", lambda: processors)
    monkeypatch.setattr(Native, "is_cached", property(lambda self: self is not sound))
    monkeypatch.setattr(warming.machine_code, "loaded", cache(lambda *_: {}))
    assert not warming.is_warm()
    warming.warm_up()
    expected = [python_command("yehu_server.core.engine.warming")]
    assert begun == (expected if processors > 1 else [])


WARM_UP = """
from yehu_server.core.engine import warming
assert not warming.is_warm()
warming.warm_up()
assert warming.is_warm()
"""
IS_WARM = """
import sys
from yehu_server.core.engine import warming
assert warming.is_warm()
def refuse(*_, **__):
    raise AssertionError("compiled again")
warming.subprocess.Popen = refuse
warming.warm_up()
assert "numba" not in sys.modules
"""


@pytest.mark.slow
def test_after_warming_up_in_an_empty_folder_all_is_kept(tmp_path):
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path)}
    for script in (WARM_UP, IS_WARM):
        subprocess.run([sys.executable, "-c", script], env=environment, check=True)
