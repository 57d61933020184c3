"""What playing needs is compiled by processes of their own, and kept."""

import os
import subprocess
import sys
from unittest.mock import Mock

import pytest

from yehu_server.compile import worker_processes
from yehu_server.core.engine import warming
from yehu_server.util.processes import python_command


@pytest.mark.parametrize(("processors", "expected"), [(1, 1), (2, 2)])
def test_what_is_not_kept_is_compiled_by_a_process_for_each_of_two_processors(
    processors, expected, monkeypatch
):
    warming.warm_up()
    command = python_command("yehu_server.compile.worker_processes")
    start, idle = worker_processes.subprocess.Popen, [sys.executable, "-c", ""]

    def begun(words, **how):
        return start(words if expected == 1 else idle, **how)  # what they do is seen of one

    for is_kept, commands in ((True, []), (False, [command] * expected)):
        with monkeypatch.context() as patch:
            popen = Mock(side_effect=begun)
            patch.setattr(worker_processes.subprocess, "Popen", popen)
            patch.setattr(worker_processes.os, "cpu_count", lambda: processors)
            if not is_kept:
                patch.setattr(warming, "is_warm", lambda: False)
            warming.warm_up()
            assert [call.args[0] for call in popen.call_args_list] == commands


def test_what_a_helper_cannot_compile_is_compiled_at_its_first_use(monkeypatch):
    monkeypatch.setattr(worker_processes, "python_command", lambda _: [sys.executable, "-c", ""])
    monkeypatch.setattr(warming, "is_warm", lambda: False)
    warming.warm_up()
    assert all(function.address for function in warming.CALLED)


WARM_UP = """
from yehu_server.core.engine import warming
assert not warming.is_warm()
warming.warm_up()
assert warming.is_warm()
"""
IS_WARM = """
import subprocess, sys
from yehu_server.core.engine import warming
assert warming.is_warm()
def refuse(*_, **__):
    raise AssertionError("compiled again")
subprocess.Popen = refuse
warming.warm_up()
assert "numba" not in sys.modules
"""


@pytest.mark.slow
def test_after_warming_up_in_an_empty_folder_all_is_kept(tmp_path):
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path)}
    for script in (WARM_UP, IS_WARM):
        subprocess.run([sys.executable, "-c", script], env=environment, check=True)
