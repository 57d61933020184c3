"""Results as zarr stores, with the extra for clusters."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from yehu_server.errors import OutputError, YehuError

if TYPE_CHECKING:
    from yehu_server.lab.sweeps.result import Result

Array = Any

CHUNK = 1 << 16  # strokes in a chunk of a column


def _zarr() -> Any:
    try:
        import zarr
    except ImportError:
        raise YehuError("zarr is missing: install yehu-server[cluster]") from None
    return zarr


def save_zarr(result: Result, target: Path, *, overwrite: bool = True) -> None:
    """Write a result as a zarr store, a folder.

    Raises
    ------
    OutputError
        Where it cannot be written.
    YehuError
        Where zarr is missing.
    """
    zarr = _zarr()
    partial = target.with_name(f".{target.name}.part")
    try:
        shutil.rmtree(partial, ignore_errors=True)
        group = zarr.open_group(str(partial), mode="w")
        for name, values in result.arrays().items():
            if values.dtype.kind == "U":
                group.attrs[name] = values.tolist()
                continue
            chunks = tuple(min(CHUNK, max(1, length)) for length in values.shape)
            array = group.create_array(name, shape=values.shape, dtype=values.dtype, chunks=chunks)
            array[...] = values
        if target.exists() and overwrite:
            shutil.rmtree(target)
        partial.rename(target)
    except OSError as error:
        shutil.rmtree(partial, ignore_errors=True)
        raise OutputError(f"{target}: cannot write: {error.strerror or error}") from error


def load_zarr(path: Path) -> dict[str, Array]:
    """The arrays of a zarr store that `save_zarr` wrote.

    Raises
    ------
    ValueError
        Where it is none.
    """
    zarr = _zarr()
    if not path.is_dir():
        raise OSError(2, "No such folder")
    group = zarr.open_group(str(path), mode="r")
    arrays = {name: np.asarray(array[...]) for name, array in group.arrays()}
    return arrays | {name: np.array(value) for name, value in dict(group.attrs).items()}
