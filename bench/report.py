"""Command line and result file of all benchmarks."""

from __future__ import annotations

import argparse
import json
import os
import platform
from pathlib import Path
from typing import Any

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
        **conditions,
        "figures": figures,
    }
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")


def processor() -> str:
    """The processor's name, as far as the system tells."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.machine()
