"""What a cluster's pickles name is neither run nor takes memory or time."""

import io
import pickle

import pytest

from yehu_server.rendering.plain_unpickling import LONGEST, ForeignError, plain

EIGHT_GIGABYTES = b"(I8000000000\n"
# Each of sixty lists has the one before twice.
DOUBLING = b"]q\x000" + b"".join(b"]q%c(h%ch%ce0" % (n, n - 1, n - 1) for n in range(1, 60))


@pytest.mark.parametrize("name", [b"bytes", b"bytearray", b"range", b"list"])
def test_a_type_that_a_pickle_calls_makes_nothing(name: bytes) -> None:
    made = plain(b"cbuiltins\n" + name + b"\n" + EIGHT_GIGABYTES + b"tR.")
    assert made == b"" or isinstance(made, ForeignError)  # Dask reads bytes by their type


@pytest.mark.parametrize("make", [b"\x85R", b"\x85\x81"], ids=["called", "new"])
def test_an_exception_with_lists_of_lists_is_soon_shown(make: bytes) -> None:
    error = plain(DOUBLING + b"cx\nStrange\nh\x3b" + make + b".")
    assert type(error).__name__ == "Strange"
    assert str(error) in ("list", "")


def test_of_texts_and_names_so_much_is_kept_and_small_numbers_stay() -> None:
    pickled = io.BytesIO()
    pickler = pickle.Pickler(pickled)
    pickler.dispatch_table = {}  # where Dask was imported, exceptions are written in another way
    pickler.dump(ForeignError("x" * 10_000, 3, 10**4000, None, *["y"] * 1000))
    error = plain(pickled.getvalue().replace(b"ForeignError", b"ForeignErrox"))
    assert error.args[:4] == ("x" * LONGEST, 3, "int", "NoneType")
    assert len(error.args) == LONGEST
    assert len(plain(b"cx\n" + b"n" * 10_000 + b"\n.").__name__) == LONGEST
