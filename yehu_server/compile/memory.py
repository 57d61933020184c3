"""Records for code that runs as plain Python (``NUMBA_DISABLE_JIT=1``)."""

import ctypes
import math
from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np

from yehu_server.compile.jit import IS_PLAIN, Deferred, imported

WORD = 8  # bytes of a number in records and between threads


class Record(np.record):  # type: ignore[misc]  # NumPy's stubs call it final
    """A record whose fields are attributes, as they are in compiled code.

    numpy.record prefers its own attributes, such as the transpose ``T``, to fields.
    """

    def __getattribute__(self, name: str) -> Any:
        if name in (np.record.__getattribute__(self, "dtype").names or ()):
            return self[name]
        return super().__getattribute__(name)

    def __setattr__(self, name: str, value: Any) -> None:
        self[name] = value


def with_attributes(kind: np.dtype[Any]) -> np.dtype[Any]:
    """Return a record type whose records, and those nested in them, are `Record`."""
    if not kind.base.names:
        return kind
    if kind.shape:
        return np.dtype((with_attributes(kind.base), kind.shape))
    fields = dict(kind.fields or {})
    formats = [with_attributes(field) for field, *_ in fields.values()]
    spec: Any = {
        "names": list(fields),
        "formats": formats,
        "offsets": [offset for _, offset, *_ in fields.values()],
        "itemsize": kind.itemsize,
    }
    return np.dtype((Record, np.dtype(spec)))


def with_fields(record: Any) -> Any:
    """View a record, for code that runs as Python, with its fields as attributes."""
    return np.asarray(record).view(with_attributes(record.dtype))[()]


if IS_PLAIN:
    np.seterr(over="ignore")  # integers wrap around, as they do in compiled code


@cache
def _kind(kind: Any) -> Any:
    return with_attributes(np.dtype(kind))


def _plain_carray(address: int, shape: tuple[int, ...], kind: Any) -> Any:
    kind = _kind(kind)
    room = (ctypes.c_char * (math.prod(shape) * kind.itemsize)).from_address(int(address))
    return np.frombuffer(room, kind).reshape(shape)


# The array of a shape and dtype at an address; nothing is copied.
carray: Callable[..., Any] = (
    _plain_carray if IS_PLAIN else Deferred(lambda: imported("numba").carray)
)
