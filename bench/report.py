"""Command line, timing, table and result file of all benchmarks."""

import argparse
import json
import os
import platform
import statistics
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

COMMAND = [sys.executable, "-c", "from yehu_server.cli import main; raise SystemExit(main())"]
NO_CARD = "JACK, dummy driver, no real-time rights"


def options(doc: str) -> argparse.ArgumentParser:
    """A command line with --save, described by the first line of a module's docstring."""
    parser = argparse.ArgumentParser(description=doc.splitlines()[0])
    parser.add_argument("--save", type=Path, help="write the figures to a JSON file")
    return parser


def save(path: Path | None, figures: object, **conditions: Any) -> None:
    """Write figures, the machine and the conditions they were measured under, where wanted."""
    if path is None:
        return
    record = {
        "machine": f"{processor()}, {os.cpu_count()} cores, {platform.system()}",
        "python": platform.python_version(),
        **({"load": round(os.getloadavg()[0], 1)} if hasattr(os, "getloadavg") else {}),
        **conditions,
        "figures": figures,
    }
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")


def run(
    doc: str | None,
    measure: Callable[[argparse.Namespace], Mapping[str, Mapping[str, Any]]],
    **more: tuple[Any, str],
) -> None:
    """Parse the command line, measure, print a table and write the figures where wanted.

    `measure`: returns the rows of the table by their names, each of values by columns.
    `more`: options by name: the default, and what it is.
    """
    parser = options(doc or "")
    for name, (default, about) in more.items():
        text = f"{about} (default: {default})"
        parser.add_argument(f"--{name}", type=type(default), default=default, help=text)
    arguments = parser.parse_args()
    figures = measure(arguments)
    show(figures)
    save(arguments.save, figures, **{name: getattr(arguments, name) for name in more})


def show(rows: Mapping[str, Mapping[str, Any]], title: str | None = None) -> None:
    """Print a table: numbers to four digits, and no lists."""
    columns = dict.fromkeys(key for row in rows.values() for key in row)
    shown = [
        column
        for column in columns
        if not any(isinstance(row.get(column), list) for row in rows.values())
    ]
    table = Table("", *shown, title=title, title_justify="left")
    for name, row in rows.items():
        cells = [row.get(column, "") for column in shown]
        table.add_row(name, *(f"{x:.4g}" if isinstance(x, float) else str(x) for x in cells))
    Console(width=None if sys.stdout.isatty() else 160).print(table)


def timed(
    work: Callable[[], object], runs: int, clock: Callable[[], float] = time.perf_counter
) -> list[float]:
    """Seconds of each run, after a first one that does not count."""
    times = []
    for _ in range(runs + 1):
        start = clock()
        work()
        times.append(clock() - start)
    return times[1:]


def spread(values: Sequence[float], unit: str = "") -> dict[str, Any]:
    """Median and extremes of runs, and all of them."""
    middle = statistics.median(values)
    found = {"median": middle, "from": min(values), "to": max(values)}
    return {**found, **({"unit": unit} if unit else {}), "all": list(values)}


def quantiles(values: Sequence[float]) -> dict[str, float]:
    """Median, extremes and standard deviation; NaN of nothing."""
    if len(values) < 2:
        return dict.fromkeys(("median", "least", "95 %", "most", "jitter"), float("nan"))
    ordered = sorted(values)
    return {
        "median": statistics.median(ordered),
        "least": ordered[0],
        "95 %": ordered[int(0.95 * len(ordered))],
        "most": ordered[-1],
        "jitter": statistics.stdev(ordered),
    }


def processor() -> str:
    """The processor's name, as far as the system reports it."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.machine()
