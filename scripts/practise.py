"""Write yehu_server/playing/practices.json, the practice for usual sample rates.

    .venv/bin/python scripts/practise.py [RATE...]

Takes some ten minutes a rate on two cores; the others stay as they are.
"""

from __future__ import annotations

import argparse
import json
import time

from yehu_server.physics.quantities import Quantities
from yehu_server.playing.calibrations import calibration_for
from yehu_server.playing.practice import Practice
from yehu_server.playing.practices import SHIPPED, as_data

RATES = (44100.0, 48000.0, 96000.0)


def main() -> None:
    """Practise at some rates, and write the file."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("rates", nargs="*", type=float, default=RATES, metavar="RATE")
    found = {entry["rate"]: entry for entry in json.loads(SHIPPED.read_text(encoding="utf-8"))}
    for rate in parser.parse_args().rates:
        start = time.perf_counter()
        table = Practice(rate, Quantities(), calibration_for(rate)).learn()
        found[rate] = as_data(table, rate)
        text = json.dumps([found[known] for known in sorted(found)], indent=1)
        SHIPPED.write_text(text + "\n", encoding="utf-8")
        print(f"{rate:g} Hz: {time.perf_counter() - start:.0f} s", flush=True)


if __name__ == "__main__":
    main()
