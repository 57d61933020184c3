"""Compiling with less work of numba's gives LLVM the code that numba gives it."""

import io
import os
import pickle
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
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


def kept_in(file: Path) -> Any:
    payload = read_checksummed(file)
    assert payload is not None
    return pickle.load(io.BytesIO(payload))  # noqa: S301 - with a checksum


def texts(folder: Path) -> dict[str, list[str]]:
    """What LLVM was given of each function, without what is of the process."""
    found = {}
    for file in sorted(folder.rglob("*.ir")):
        _, _, (modules, _) = kept_in(file)
        text = "".join(str(binding.parse_bitcode(module)) for module in modules)
        found[file.name.partition("-")[0]] = re.sub(r"(globals\.|i64 )[0-9a-f]{9,}", "", text)
    return found


@pytest.mark.slow
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


# Two functions of ours that need the same ones of numba's own: which of these is numba's first, and
# so what numba calls it, is another in each process.
IN_ORDER = """
import sys
from yehu_server.compile.jit import with_called
from yehu_server.core.engine.native import post_from, read_reports
from yehu_server.core.physics.kernel import derive
for function in list(with_called([post_from, read_reports, derive]))[:: int(sys.argv[1])]:
    function.keep()
"""


def names(folder: Path) -> dict[str, list[str]]:
    """What is defined in each function's own modules, and in those of numba's that it links."""
    found = {}
    for file in sorted(folder.rglob("*.ir")):
        _, _, (modules, links) = kept_in(file)
        own = [*modules, *(link for link in links if isinstance(link, bytes))]
        parsed = map(binding.parse_bitcode, own)
        found[file.name] = sorted(each.name for module in parsed for each in module.functions)
    return found


@pytest.mark.slow
def test_what_is_kept_names_what_it_links_alike_in_whatever_order_it_is_compiled(tmp_path):
    kept = []
    for step in ("1", "-1"):
        environment = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path / step)}
        subprocess.run([sys.executable, "-c", IN_ORDER, step], env=environment, check=True)
        kept.append(names(tmp_path / step))
    assert len(kept[0]) > 5
    assert kept[0] == kept[1]
