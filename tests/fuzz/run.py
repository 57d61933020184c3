"""Fuzzes every reader in turn, each in its own process.

    .venv/bin/python tests/fuzz/run.py --seconds 600
    .venv/bin/python tests/fuzz/run.py --seconds 60 --target preset mapping
    .venv/bin/python tests/fuzz/run.py --target preset --input FILE

Prints a table, and the smallest input of each finding; with findings the exit code is 1.
With atheris coverage guides the inputs; without it they are guessed.
"""

from __future__ import annotations

import argparse
import importlib
import logging
import os
import shutil
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType

os.environ["OPENBLAS_NUM_THREADS"] = "1"  # processes are forked off this one
sys.path[:0] = [str(Path(__file__).parents[1]), str(Path(__file__).parents[2])]

from fuzz.findings import broken, described, smaller
from fuzz.target import TARGETS, Target, scratch

SEED = 1
HEAD = ("target", "seconds", "executions", "a second", "edges / features", "findings")


@dataclass(frozen=True)
class Outcome:
    """The result of fuzzing one target."""

    target: Target
    seconds: float
    executions: int
    covered: str
    findings: list[bytes]
    log: str = ""  # of a target that ended unexpectedly

    @property
    def row(self) -> tuple[str, ...]:
        """As a row of the table."""
        rate = self.executions / max(self.seconds, 1e-9)
        count = f"{len(self.findings)}" if not self.log else "died"
        seconds = f"{self.seconds:.0f}"
        return self.target.name, seconds, f"{self.executions}", f"{rate:.0f}", self.covered, count


def engine_named(name: str) -> ModuleType:
    """The engine asked for; ``any`` is atheris if it is installed."""
    if name != "hypothesis":
        try:
            return importlib.import_module("fuzz.guided")
        except ImportError:
            if name == "atheris":
                raise
            print("atheris is not to be had here: inputs are guessed", file=sys.stderr)
    return importlib.import_module("fuzz.guessed")


def load_targets(engine: ModuleType) -> None:
    """Import all targets, with coverage where the engine can watch it."""
    if hasattr(engine, "watched"):
        with engine.watched():
            importlib.import_module("fuzz.targets")
    else:
        importlib.import_module("fuzz.targets")


def fuzzed(target: Target, engine: ModuleType, seconds: float, seed: int) -> Outcome:
    """Fuzz one target in a forked process."""
    folder = Path(tempfile.mkdtemp(prefix=f"{target.name}-", dir=scratch()))
    log = folder / "log"
    sys.stdout.flush()
    start = time.monotonic()
    child = os.fork()
    if child == 0:
        code = 1
        try:
            with log.open("wb") as file:
                for stream in (1, 2):
                    os.dup2(file.fileno(), stream)
            os.chdir(folder)
            engine.fuzz(target, seconds, seed, folder)
            code = 0
        finally:
            sys.stderr.flush()
            os._exit(code)
    _, status = os.waitpid(child, 0)
    took = time.monotonic() - start
    said = log.read_text(errors="replace")
    executions, covered = engine.figures(said)
    findings = [file.read_bytes() for file in sorted(folder.glob(f"{target.name}-*"))]
    shutil.rmtree(folder)
    return Outcome(target, took, executions, covered, findings, said[-3000:] if status else "")


def kept(outcome: Outcome, folder: Path) -> list[Path]:
    """Print each finding at its smallest, and save it in the folder."""
    files = []
    for number, data in enumerate(outcome.findings, start=1):
        least = smaller(outcome.target, data)
        file = folder / f"{outcome.target.name}-{number}"
        file.write_bytes(least)
        files.append(file)
        print(f"\n{described(outcome.target, least)}\nkept in {file}\n")
    if outcome.log:
        print(f"\n{outcome.target.name}: the process died\n{outcome.log}")
    return files


def table(rows: list[tuple[str, ...]]) -> str:
    """Rows as a Markdown table."""
    widths = [max(len(row[column]) for row in (HEAD, *rows)) for column in range(len(HEAD))]
    rule = [":" + "-" * (widths[0] - 1), *("-" * (width - 1) + ":" for width in widths[1:])]

    def line(cells: tuple[str, ...] | list[str]) -> str:
        first = cells[0].ljust(widths[0])
        others = (cell.rjust(width) for cell, width in zip(cells[1:], widths[1:], strict=True))
        return f"| {' | '.join((first, *others))} |"

    return "\n".join(map(line, (HEAD, rule, *rows)))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--seconds", type=float, default=60.0, help="for each target (default: 60)")
    parser.add_argument("--target", nargs="+", default=[], metavar="NAME", help="default: all")
    parser.add_argument("--engine", choices=("any", "atheris", "hypothesis"), default="any")
    parser.add_argument("--seed", type=int, default=SEED, help=f"of chance (default: {SEED})")
    parser.add_argument("--input", type=Path, metavar="FILE", help="try this input, and no other")
    parser.add_argument("--findings", type=Path, metavar="FOLDER", help="where findings are kept")
    parser.add_argument("--list", action="store_true", help="tell the targets and their contracts")
    options = parser.parse_args()

    logging.disable(logging.WARNING)  # readers' warnings about bad input
    engine = engine_named(options.engine)
    load_targets(engine)
    for name in options.target:
        if name not in TARGETS:
            parser.error(f"no target {name!r} (there are: {', '.join(TARGETS)})")
    targets = [TARGETS[name] for name in options.target or TARGETS]
    if options.list:
        for target in targets:
            print(f"{target.name}: {target.contract}")
        return 0
    if options.input is not None:
        data = options.input.read_bytes()
        wrong = [target for target in targets if broken(target, data)]
        for target in wrong:
            print(described(target, data))
        return 1 if wrong else 0

    folder = options.findings or Path(tempfile.mkdtemp(prefix="yehu-findings-"))
    folder.mkdir(parents=True, exist_ok=True)
    rows, found = [], []
    for target in targets:
        outcome = fuzzed(target, engine, options.seconds, options.seed)
        rows.append(outcome.row)
        print("  ".join(outcome.row), file=sys.stderr, flush=True)
        found += kept(outcome, folder)
        found += [folder] if outcome.log else []
    print(table(rows))
    if not found and options.findings is None:
        folder.rmdir()
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
