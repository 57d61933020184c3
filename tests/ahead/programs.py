"""Compiles this folder's C programs with the library."""

import os
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).parent
STRICT = ["-std=c11", "-Wall", "-Wextra", "-pedantic", "-Werror"]


def compiled(library: Path, into: Path, *sources: str) -> Path:
    """A program of some of this folder's files and the library."""
    libraries = ["-L", str(library), "-lyehu", f"-Wl,-rpath,{library}", "-rdynamic"]
    files = [str(HERE / source) for source in sources]
    command = ["cc", *STRICT, f"-I{library}", *files, "-o", str(into), *libraries]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return into


def run_in_plain_python(script: str, *words: object) -> None:
    """Run one of this folder's scripts without the JIT."""
    paths = os.pathsep.join(map(str, (HERE.parent, HERE.parents[1])))
    environment = {**os.environ, "NUMBA_DISABLE_JIT": "1", "PYTHONPATH": paths}
    command = [sys.executable, str(HERE / script), *map(str, words)]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
