"""Run the playability study, a million strokes, and keep its maps.

    .venv/bin/python scripts/playability_study/run_study.py FOLDER [--workers N]

It writes a result for each study of this folder to FOLDER, and goes on where it was interrupted.
Then it writes `maps.npz` beside itself, small enough for this repository: of each study the regimes
and the periods to Helmholtz motion on the finest grid, the axes, and Schelleng's limits.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

import numpy as np
from maps import FILE, KINDS, NEVER

from yehu_lab.sweeps.result import Result
from yehu_lab.sweeps.running import sweep_to
from yehu_lab.sweeps.study import limits_of, read_study

MOST = NEVER - 1  # periods to Helmholtz motion, by bytes
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
    """Run what is not done, and write the maps."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("folder", type=Path, metavar="FOLDER")
    parser.add_argument("--workers", type=int, metavar="N")
    arguments = parser.parse_args()
    arguments.folder.mkdir(parents=True, exist_ok=True)
    arrays: dict[str, Any] = {}
    for name in (f"{kind}_{string}" for kind in KINDS for string in (1, 2)):
        target = arguments.folder / f"{name}.npz"
        if not target.exists():
            study = read_study(FILE.with_name(f"{name}.toml"))
            sweep_to(study, target, workers=arguments.workers)
        print(target, flush=True)
        arrays |= kept(Result.load(target), name)
    np.savez_compressed(FILE, allow_pickle=False, **arrays)
    print(f"{FILE}: {FILE.stat().st_size / 1e6:.2f} MB")


if __name__ == "__main__":
    main()
