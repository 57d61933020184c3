"""Fuzzing by atheris, guided by coverage: inputs that reach new code are varied further."""

from __future__ import annotations

import contextlib
import io
import os
import re
import resource
from collections.abc import Iterator
from pathlib import Path

import atheris
from fuzz.findings import Findings
from fuzz.target import MOST_BYTES, ROOT, Target

GUIDED_BY = ["yehu_server", "yehu_lab", "tomllib"]
MOST_RESIDENT_MB = 2048
STUCK_S = 60  # in one input, where no signal reaches Python
_LAST = re.compile(r"#\d+\s+DONE\s+cov: (\d+) ft: (\d+)")
_EXECUTIONS = re.compile(r"stat::number_of_executed_units: (\d+)")


@contextlib.contextmanager
def watched() -> Iterator[None]:
    """Watch the modules imported in the block, except those that numba compiles."""
    package = ROOT / "yehu_server"
    compiled = [
        f"yehu_server.{folder}.{file.stem}"
        for folder in ("core.physics", "core.controls", "core.player", "core.engine")
        for file in (package / folder.replace(".", "/")).glob("*.py")
        if file.stem != "quantities"  # reads body and instrument files
    ]
    with (
        contextlib.redirect_stderr(io.StringIO()),  # a line for each module
        atheris.instrument_imports(GUIDED_BY, [*compiled, "yehu_server.compile.jit"]),
    ):
        yield


def _resident_mb() -> int:
    """Peak memory of this process, which begins at that of its parent."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss >> 10


def fuzz(target: Target, seconds: float, seed: int, folder: Path) -> None:
    """Fuzz for some seconds, in this process, which ends with it."""
    findings = Findings(target, folder)
    words, seeds, corpus = (folder / name for name in ("words", "seeds", "corpus"))
    for made in (seeds, corpus):
        made.mkdir()
    for name, data in target.seeds().items():
        (seeds / name).write_bytes(data)
    lines = ("".join(f"\\x{byte:02x}" for byte in word) for word in target.words)
    words.write_text("".join(f'"{line}"\n' for line in lines))
    options = [
        f"-max_total_time={max(1, round(seconds))}",
        f"-seed={seed}",
        *([f"-dict={words}"] if target.words else []),
        f"-max_len={MOST_BYTES}",
        f"-rss_limit_mb={MOST_RESIDENT_MB + _resident_mb()}",
        f"-timeout={STUCK_S}",
        f"-artifact_prefix={folder}/{target.name}-fatal-",
        "-print_final_stats=1",
    ]
    atheris.Setup([target.name, *options, str(corpus), str(seeds)], findings.take)
    atheris.Fuzz()
    os._exit(0)


def figures(log: str) -> tuple[int, str]:
    """Executions, and edges and features covered, from the log."""
    executions, last = _EXECUTIONS.search(log), _LAST.search(log)
    covered = f"{last[1]} / {last[2]}" if last else "?"
    return int(executions[1]) if executions else 0, covered
