"""Compiling with less work of numba's gives LLVM the code that numba gives it."""

import io
import os
import pickle
import re
import subprocess
import sys
from pathlib import Path

from llvmlite import binding

from yehu_server.util.checksummed import read_checksummed

COMPILE = """
import sys, types
if "numba's own" in sys.argv:
    from numba.core.compiler import Compiler
    sys.modules["yehu_server.compile.numba_shortcuts"] = types.ModuleType("without")
    passes = sys.modules["yehu_server.compile.numba_passes"] = types.ModuleType("without")
    passes.LeanCompiler = Compiler
from yehu_server.compile.jit import with_called
from yehu_server.core.engine.native import post_from, read_reports
from yehu_server.core.physics.kernel import derive
for function in with_called([post_from, read_reports, derive]):
    function.keep()
"""


def texts(folder: Path) -> dict[str, list[str]]:
    """What LLVM was given of each function, without what is of the process."""
    found = {}
    for file in sorted(folder.rglob("*.ir")):
        payload = read_checksummed(file)
        assert payload is not None
        _, _, (modules, _) = pickle.load(io.BytesIO(payload))  # noqa: S301 - with a checksum
        text = "".join(str(binding.parse_bitcode(module)) for module in modules)
        found[file.name.partition("-")[0]] = re.sub(r"(globals\.|i64 )[0-9a-f]{9,}", "", text)
    return found


def test_llvm_is_given_the_same_code_as_by_numba_itself(tmp_path):
    for how in ("numba's own", "ours"):
        environment = {
            **os.environ,
            "NUMBA_CACHE_DIR": str(tmp_path / how),
            "PYTHONHASHSEED": "0",  # names have the options, in the order of a set
        }
        subprocess.run([sys.executable, "-c", COMPILE, how], env=environment, check=True)
    expected = texts(tmp_path / "numba's own")
    assert len(expected) > 5
    assert texts(tmp_path / "ours") == expected
