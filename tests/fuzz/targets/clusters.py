"""What a cluster sends to the machine of the command."""

import pickle

from fuzz.target import target

from yehu_server.rendering.plain_unpickling import ForeignError, plain

PLAIN = (type(None), bool, int, float, complex, str, bytes, bytearray)
MANY = (list, tuple, set, frozenset)


class DamagedError(Exception):
    """What is no pickle."""


@target(
    "cluster-pickle",
    DamagedError,
    words=(b"cos\nsystem\n", b"cbuiltins\neval\n", b"\x8c\x02os\x8c\x06system\x93", b"\x85R",
           b"\x81", b"cbuiltins\ngetattr\n", b"b.", b"\x93\x94", b"}(", b"u.", b"s.", b"a."),
)  # fmt: skip
def cluster_pickle(data: bytes) -> None:
    """Any pickle gives plain values and inert stand-ins, or is damaged: nothing it names is run."""
    try:
        found = plain(data)
    except (Exception, MemoryError) as error:
        if isinstance(error, pickle.PicklingError):
            raise
        raise DamagedError(f"{type(error).__name__}") from error
    check(found, 0)


def check(value: object, depth: int) -> None:
    if depth > 20:
        return
    if isinstance(value, dict):
        for key, entry in value.items():
            check(key, depth + 1)
            check(entry, depth + 1)
    elif isinstance(value, MANY):
        for entry in value:
            check(entry, depth + 1)
    else:
        is_stand_in = isinstance(value, type) and issubclass(value, ForeignError)
        is_function = getattr(value, "__module__", "") == plain.__module__
        assert isinstance(value, (*PLAIN, ForeignError)) or is_stand_in or is_function, type(value)
