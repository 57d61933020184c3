"""A disk that is full, for tests of this folder."""

import signal
from collections.abc import Callable, Iterator

import pytest


@pytest.fixture
def limited() -> Iterator[Callable[[int], None]]:
    """Make the disk full: no file may grow beyond so many bytes."""
    resource = pytest.importorskip("resource", reason="there is no such limit on Windows")
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    handler = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    yield lambda most_bytes: resource.setrlimit(resource.RLIMIT_FSIZE, (most_bytes, hard))
    resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    signal.signal(signal.SIGXFSZ, handler)
