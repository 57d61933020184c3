"""Writes the sums of renders that `tests/test_renders.py` holds every processor to.

    .venv/bin/python scripts/render_sums.py [LEVEL ...]

For each level of processors that this one can run, or the named ones. Run it where a change is to
change samples; its commit says why they do.
"""

import argparse
import json
import os
import subprocess
import sys
from pathlib import Path

from yehu_server.compile import levels

TESTS = Path(__file__).resolve().parents[1] / "tests"
SUMS = TESTS / "renders.json"


def main() -> None:
    """Render all for each level, and write the sums; those of other levels stay."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    runnable = [level for level in levels.levels() if not levels.missing(level)]
    parser.add_argument("levels", metavar="LEVEL", nargs="*", choices=[*runnable, []])
    sums = json.loads(SUMS.read_text()) if SUMS.exists() else {}
    for level in parser.parse_args().levels or runnable:
        made = subprocess.run(  # noqa: S603 - our own
            [sys.executable, str(TESTS / "renders.py")],
            env={**os.environ, levels.VARIABLE: level},
            check=True,
            stdout=subprocess.PIPE,
            text=True,
        )
        before, sums[level] = sums.get(level, {}), json.loads(made.stdout)
        changed = [name for name in sums[level] if sums[level][name] != before.get(name)]
        print(f"{level}: {', '.join(changed) or 'nothing'} changed")
    SUMS.write_text(json.dumps(sums, indent=1) + "\n")


if __name__ == "__main__":
    main()
