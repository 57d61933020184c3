"""Write yehu_server/playing/practices.json, the bowing tables for usual sample rates.

    .venv/bin/python scripts/practise.py [--anew] [RATE...]

Goes on from what is stored, or, with --anew, from all notes bowed alike. Practises at the usual
place of the bow, calibrates with that, and practises at the others. Takes some 15 minutes a rate on
two cores, more anew; the other rates stay as they are. Then run scripts/calibrate.py, so that the
calibrations belong to it.
"""

import argparse
import json
import time

from yehu_lab.practising.bowing_search import BowingSearch
from yehu_lab.practising.candidates import DEFAULT
from yehu_lab.practising.practice_file import as_data, as_text
from yehu_server.core.physics.default_quantities import Quantities
from yehu_server.core.player.bowing import BOW_POSITIONS, default_bowing_table
from yehu_server.playing.bowing_tables import SHIPPED, shipped_bowing_table
from yehu_server.playing.calibration import calibrate
from yehu_server.playing.calibration_store import calibration_for

RATES = (44100.0, 48000.0, 96000.0)


def main() -> None:
    """Practise at some rates, and write the file."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("rates", nargs="*", type=float, default=RATES, metavar="RATE")
    parser.add_argument("--anew", action="store_true", help="forget what is stored")
    arguments = parser.parse_args()
    found = {entry["rate"]: entry for entry in json.loads(SHIPPED.read_text(encoding="utf-8"))}
    for rate in arguments.rates:
        start = time.perf_counter()
        quantities = Quantities()
        known = default_bowing_table() if arguments.anew else shipped_bowing_table(rate)
        table = BowingSearch(rate, quantities, calibration_for(rate)).learn(
            table=known, places=(DEFAULT,)
        )
        print(f"{rate:g} Hz: {time.perf_counter() - start:.0f} s, usual place", flush=True)
        calibration = calibrate(rate, quantities, bowing=table)
        others = set(range(len(BOW_POSITIONS))) - {DEFAULT}
        table = BowingSearch(rate, quantities, calibration).learn(table=table, places=others)
        found[rate] = as_data(table, rate)
        SHIPPED.write_text(as_text([found[known] for known in sorted(found)]), encoding="utf-8")
        print(f"{rate:g} Hz: {time.perf_counter() - start:.0f} s", flush=True)


if __name__ == "__main__":
    main()
