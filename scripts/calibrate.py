"""Write yehu_server/playing/calibrations.json: the instrument in tune at the usual rates.

.venv/bin/python scripts/calibrate.py
"""

from __future__ import annotations

import json
import time

from yehu_server.physics.quantities import Quantities
from yehu_server.playing.calibration import calibrate, calibration_key
from yehu_server.playing.calibrations import SHIPPED, as_data

RATES = (44100.0, 48000.0, 96000.0)


def main() -> None:
    """Measure and write."""
    quantities = Quantities()
    shipped = {}
    for rate in RATES:
        start = time.perf_counter()
        data = as_data(calibrate(rate, quantities))
        shipped[calibration_key(rate, quantities, 440.0)] = {"rate": rate, **data}
        print(f"{rate:g} Hz: {time.perf_counter() - start:.1f} s", flush=True)
    SHIPPED.write_text(json.dumps(shipped, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
