"""What a study found: a table of its strokes, in one file."""

from __future__ import annotations

import json
import math
import os
import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from yehu_lab.labels import label_of
from yehu_lab.regimes.columns import FINDING, HELMHOLTZ, REGIMES
from yehu_lab.sweeps.axes import fill
from yehu_lab.sweeps.study import Study, study_of
from yehu_server.errors import ParameterError
from yehu_server.simulation.labels import as_data, as_json, hash_of
from yehu_server.util import __version__
from yehu_server.util.hints import require_package
from yehu_server.util.npz_file import read_npz, writing_npz

if TYPE_CHECKING:
    import xarray

Array = NDArray[Any]

FORMAT, VERSION = "yehu-server sweep", 1
COLUMNS = tuple(FINDING.names or ())
# Of a file, so that a small one cannot fill the memory.
MIN_GRID, MAX_EMPTY = 2**23, 1024  # points of the finest grid; times the computed ones
OF_BOW = {"force", "position", "speed", "acceleration", "noise", "seed"}
OF_BOW |= {"bow_force", "bow_position", "bow_velocity", "bow_acceleration", "bow_noise"}


@dataclass(frozen=True)
class Result:
    """What a study found.

    Attributes
    ----------
    meta : dict
        ``format``, ``version``, ``made_by``, ``regimes``, ``study`` (the data of its file),
        ``gesture``, ``refine``, ``levels``; ``sample_rate`` and ``instrument`` (all quantities) of
        the first stroke.
    axes : dict
        The values of the finest grid along each axis, by name.
    numbers : ndarray [dtype=int64]
        The computed points, in order: places on the grid, the last axis changing fastest.
    columns : dict
        A finding of each computed point, by the names of COLUMNS.
    """

    meta: Mapping[str, Any]
    axes: Mapping[str, Array]
    numbers: Array
    columns: Mapping[str, Array]

    def __len__(self) -> int:
        """Number of strokes."""
        return len(self.numbers)

    @property
    def shape(self) -> tuple[int, ...]:
        """Of the finest grid."""
        return tuple(len(values) for values in self.axes.values())

    @property
    def index(self) -> Array:
        """The place of each stroke on each axis [shape=(strokes, axes)]."""
        return np.stack(np.unravel_index(self.numbers, self.shape), axis=1)

    @property
    def regimes(self) -> tuple[str, ...]:
        """The names of the numbers in the column ``regime``."""
        return tuple(self.meta["regimes"])

    def grid(self, name: str) -> Array:
        """A column on the whole finest grid [shape=shape].

        What refinement left out is as the computed point below it, whose cell was all alike.

        Raises
        ------
        ParameterError
            Where there is no such column.
        """
        if name not in self.columns:
            raise ParameterError(f"unknown column {name!r} (known: {', '.join(self.columns)})")
        refine, levels = self.meta["refine"], self.meta["levels"]
        found: Array = fill(self.shape, refine, levels, self.numbers, self.columns[name])
        return found

    def onset_periods(self) -> Array:
        """Periods from the first slip to lasting Helmholtz motion, on the grid; NaN for never.

        Also NaN where the stroke then left it again. A period is that of the pitch at the end.
        """
        seconds = self.grid("helmholtz_s") - self.grid("first_slip_s")
        return np.where(self.grid("regime") == HELMHOLTZ, seconds * self.grid("pitch_hz"), np.nan)

    def flattening(self) -> Array:
        """Cents by which Helmholtz motion is off the usual pitch, on the grid; NaN elsewhere.

        The usual pitch is the median over all that the bow does, and one for each value of the
        other axes, such as the note: so it is zero in the middle, and below where force flattens.
        """
        is_helmholtz = self.grid("regime") == HELMHOLTZ
        pitch = np.where(is_helmholtz, self.grid("pitch_hz").astype(np.float64), np.nan)
        bow = tuple(i for i, name in enumerate(self.axes) if name in OF_BOW)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RuntimeWarning)  # where no motion is Helmholtz's
            usual = np.nanmedian(pitch, axis=bow, keepdims=True)
        return 1200.0 * np.log2(pitch / usual)

    def study(self) -> Study:
        """The study that found it.

        Raises
        ------
        ParameterError
            Where it names a file that is not in this folder.
        """
        return study_of(dict(self.meta["study"]), Path())

    def __repr__(self) -> str:
        axes = ", ".join(f"{name} ({len(values)})" for name, values in self.axes.items())
        return f"<yehu_server.Sweep of {len(self)} strokes over {axes}>"

    def to_xarray(self) -> xarray.Dataset:
        """Everything as a data set on the finest grid, by the names of the axes.

        ``computed`` says which points were; see `grid` for the others. Its attributes are text and
        numbers, so that any format holds them: the version, the study as JSON, the rate, and the
        hash of the values.

        Raises
        ------
        ParameterError
            Where xarray is missing.
        """
        require_package("xarray", "to_xarray", "lab")
        import xarray

        names = tuple(self.axes)
        computed = np.zeros(self.shape, bool)
        computed.reshape(-1)[self.numbers] = True
        grids = {name: self.grid(name) for name in self.columns} | {"computed": computed}
        found: dict[str, Any] = {
            name: (names, grid, label_of(name).attributes) for name, grid in grids.items()
        }
        axes = {
            name: (name, values, label_of(name).attributes) for name, values in self.axes.items()
        }
        # As CF conventions have it: names of the numbers, without spaces.
        found["regime"][2]["flag_values"] = list(range(len(self.regimes)))
        meanings = " ".join(name.replace(" ", "_") for name in self.regimes)
        found["regime"][2]["flag_meanings"] = meanings
        study = self.meta["study"]
        attributes = {
            "title": str(study.get("about", "")),
            "source": str(self.meta["made_by"]),
            "sample_rate": float(self.meta.get("sample_rate", math.nan)),  # none in older files
            "instrument": as_json(self.meta.get("instrument", {})),
            "study": as_json(study),
            "sha256": hash_of({**self.axes, "numbers": self.numbers, **self.columns}),
        }
        return xarray.Dataset(found, coords=axes, attrs=attributes)

    def save(self, target: str | os.PathLike[str], *, overwrite: bool = False) -> None:
        """Write one compressed ``.npz`` file; the same result makes the same bytes.

        Parameters
        ----------
        overwrite : bool
            Replace a file that is there.

        Raises
        ------
        OutputError
            Where it cannot be written.
        """
        with writing_npz(Path(target), overwrite=overwrite) as file:
            np.savez_compressed(file, allow_pickle=False, **self.arrays())

    def arrays(self) -> dict[str, Array]:
        """All of it by the names that the file has."""
        axes = {f"axis_{name}": values for name, values in self.axes.items()}
        meta = np.array(json.dumps(self.meta))
        return {"meta": meta, **axes, "numbers": self.numbers, **self.columns}

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Result:
        """Read a file that `save` or the command wrote.

        Raises
        ------
        ScoreError
            Where it cannot be read, or is none.
        """
        return read_npz(Path(path), cls.of, "the result of a sweep")

    @classmethod
    def of(cls, arrays: Mapping[str, Array]) -> Result:
        """Build it of the arrays of a file. Raises ValueError where they are no result."""
        meta = json.loads(str(arrays["meta"]))
        if meta["format"] != FORMAT or meta["version"] != VERSION:
            raise ValueError("another format")
        axes = {name: arrays[f"axis_{name}"] for name in meta["axes"]}
        columns = {name: arrays[name] for name in COLUMNS}
        numbers = arrays["numbers"]
        size = int(np.prod([len(values) for values in axes.values()], dtype=np.int64))
        if any(column.shape != (len(numbers),) for column in (numbers, *columns.values())):
            raise ValueError("columns of other lengths")
        if numbers.dtype.kind not in "iu" or any(values.ndim != 1 for values in axes.values()):
            raise ValueError("axes or points of another kind")
        if size > max(MIN_GRID, MAX_EMPTY * len(numbers)):
            raise ValueError("hardly anything on a huge grid")
        if columns["regime"].max(initial=0) >= len(meta["regimes"]):
            raise ValueError("a regime without a name")
        if not {"spreads", "refine", "levels", "study", "made_by"} <= meta.keys():
            raise ValueError("something is missing")
        if len(numbers) == 0 or numbers.min() < 0 or numbers.max() >= size:
            raise ValueError("points off the grid")
        return cls(meta, axes, numbers, columns)


def result_of(study: Study, numbers: Array, findings: Array) -> Result:
    """The result of the points of a study, in any order."""
    order = np.argsort(numbers, kind="stable")
    data = {name: entry for name, entry in study.data.items() if name != "folder"}
    first = study.bow.gesture(study.axes, [0] * len(study.axes))
    meta = {
        "format": FORMAT,
        "version": VERSION,
        "made_by": f"yehu-server {__version__}",
        "regimes": list(REGIMES),
        "axes": [axis.name for axis in study.axes],
        "spreads": [axis.spread for axis in study.axes],
        "refine": list(study.refine),
        "levels": study.levels,
        "sample_rate": first.sample_rate,
        "instrument": as_data(first.quantities),
        "study": data,
        "gesture": data.get("gesture", {}),
    }
    columns = {name: np.ascontiguousarray(findings[name][order]) for name in COLUMNS}
    axes = {axis.name: axis.as_array() for axis in study.axes}
    return Result(meta, axes, numbers[order], columns)
