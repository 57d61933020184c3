"""What playing needs is compiled in two processes, and kept."""

import os
import subprocess
import sys
from functools import cache
from unittest.mock import Mock

import pytest

from yehu_server.compile.jit import Native
from yehu_server.core.engine import warming
from yehu_server.core.engine.sounding import sound
from yehu_server.util.processes import python_command


def test_what_is_not_kept_is_compiled_by_two_processes_where_there_are_two_processors(monkeypatch):
    warming.warm_up()
    command = python_command("yehu_server.core.engine.warming")
    for is_kept, processors, expected in ((True, 2, []), (False, 1, []), (False, 2, [command])):
        with monkeypatch.context() as patch:
            popen = Mock()
            popen.return_value.wait.return_value = 0
            patch.setattr(warming.subprocess, "Popen", popen)
            patch.setattr(warming.os, "cpu_count", lambda count=processors: count)
            if not is_kept:
                patch.setattr(Native, "is_cached", property(lambda self: self is not sound))
                patch.setattr(warming.machine_code, "loaded", cache(lambda *_: {}))
            assert warming.is_warm() == is_kept
            warming.warm_up()
            assert [call.args[0] for call in popen.call_args_list] == expected


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
