"""Keep the maps of the playability study: small enough for this repository.

    .venv/bin/python scripts/playability_study/keep.py FOLDER

It reads what `run_study.py` wrote to FOLDER, and writes `maps.npz` beside itself: of each study the
regimes and the periods to Helmholtz motion on the finest grid, the axes, and Schelleng's limits.
"""

from __future__ import annotations

import argparse
import itertools
import json
from pathlib import Path
from typing import Any

import numpy as np
from run_study import HERE, ORDER

from yehu_server.lab.sweeps.limits import limits_of
from yehu_server.lab.sweeps.result import Result

NEVER, MOST = 255, 254  # periods to Helmholtz motion, by bytes
ALONG = 23  # places at which limits are kept


def kept(result: Result, name: str) -> dict[str, Any]:
    """The arrays that are kept of a study, by names that begin with its own."""
    periods = result.onset_periods()
    bytes_ = np.where(np.isfinite(periods), np.clip(np.nan_to_num(periods), 0, MOST), NEVER)
    first, y, x = result.axes
    places = np.unique(np.linspace(0, len(result.axes[x]) - 1, ALONG).astype(int))
    study = result.study()
    maps = range(len(result.axes[first]) if first == "note" else 1)
    found = [[limits_of(study, {first: i, x: int(place)}) for place in places] for i in maps]
    facts = {
        "axes": [first, y, x],
        "strokes": len(result),
        "regimes": result.regimes,
        "levels": result.meta["levels"],
        "about": result.meta["study"]["about"],
        "faults": int((result.columns["faults"] > 0).sum()),
        "counts": np.bincount(result.columns["regime"], minlength=len(result.regimes)).tolist(),
    }
    arrays = {
        "facts": np.array(json.dumps(facts)),
        "regime": result.grid("regime"),
        "periods": bytes_.astype(np.uint8),
        "places": places,
        "lower": np.array([[each.lower for each in row] for row in found], np.float32),
        "upper": np.array([[each.upper for each in row] for row in found], np.float32),
    }
    arrays |= {f"axis_{axis}": result.axes[axis] for axis in (first, y, x)}
    return {f"{name}/{key}": value for key, value in arrays.items()}


def main() -> None:
    """Read the results and write the maps."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("folder", type=Path, metavar="FOLDER")
    arguments = parser.parse_args()
    files = [(name, arguments.folder / f"{name}.npz") for name in ORDER]
    arrays = [kept(Result.load(file), name).items() for name, file in files if file.exists()]
    target = HERE / "maps.npz"
    np.savez_compressed(target, allow_pickle=False, **dict(itertools.chain.from_iterable(arrays)))
    print(f"{target}: {target.stat().st_size / 1e6:.2f} MB")


if __name__ == "__main__":
    main()
