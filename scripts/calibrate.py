"""Write yehu_server/playing/calibrations.json, the calibrations for the usual sample rates.

    .venv/bin/python scripts/calibrate.py [--keep]

With --keep nothing is measured: the stored values get the keys of the current code. Use it after
changes that leave every sample as it was, such as new names or another order of the code.
"""

from __future__ import annotations

import argparse
import json
import time
from dataclasses import asdict

from yehu_server.core.physics.quantities import Quantities
from yehu_server.playing.calibration import calibrate, calibration_key
from yehu_server.playing.calibration_store import SHIPPED

RATES = (44100.0, 48000.0, 96000.0)


def main() -> None:
    """Measure the calibrations, or keep the stored ones, and write the file."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--keep", action="store_true", help="keep the stored values, with new keys")
    keep = parser.parse_args().keep
    kept = {data["rate"]: data for data in json.loads(SHIPPED.read_text(encoding="utf-8")).values()}
    quantities = Quantities()
    shipped = {}
    for rate in RATES:
        start = time.perf_counter()
        data = kept[rate] if keep else {"rate": rate, **asdict(calibrate(rate, quantities))}
        shipped[calibration_key(rate, quantities, 440.0)] = data
        print(f"{rate:g} Hz: {time.perf_counter() - start:.1f} s", flush=True)
    SHIPPED.write_text(json.dumps(shipped, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
