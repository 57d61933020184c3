"""Measure the calibrations for the usual sample rates anew: yehu_server/playing/calibrations.json.

    .venv/bin/python scripts/calibrate.py

Where no sample changes, `scripts/generate` keeps the figures, under keys of the new code.
"""

import argparse
import json
import time
from dataclasses import asdict

from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.playing.calibration import calibrate, calibration_key
from yehu_server.playing.calibration_store import SHIPPED

RATES = (44100.0, 48000.0, 96000.0)

if __name__ == "__main__":
    argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    ).parse_args()
    quantities = Quantities()
    shipped = {}
    for rate in RATES:
        start = time.perf_counter()
        data = {"rate": rate, **asdict(calibrate(rate, quantities))}
        shipped[calibration_key(rate, quantities, 440.0)] = data
        print(f"{rate:g} Hz: {time.perf_counter() - start:.1f} s", flush=True)
    SHIPPED.write_text(json.dumps(shipped, indent=1) + "\n", encoding="utf-8")
