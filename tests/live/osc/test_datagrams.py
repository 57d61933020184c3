"""Reading datagrams: both readers tell the same, and the one for bursts keeps the GIL."""

from __future__ import annotations

import itertools
import socket
import sys
import threading
import time
from collections.abc import Callable, Iterator

import pytest

from yehu_server.live.osc.open_sockets import (
    AT_ONCE,
    DATAGRAM_BYTES,
    BatchReader,
    SingleReader,
    datagrams,
    mute,
    widen,
)

HERE = {socket.AF_INET: "127.0.0.1", socket.AF_INET6: "::1"}
on_linux = pytest.mark.skipif(sys.platform != "linux", reason="recvmmsg is Linux's")
READERS = [SingleReader, pytest.param(datagrams, marks=on_linux)]
Pair = tuple[socket.socket, socket.socket]


@pytest.fixture(params=HERE, ids=lambda family: family.name)
def pair(request) -> Iterator[Pair]:
    """A socket that hears, and one that sends to it."""
    with (
        socket.socket(request.param, socket.SOCK_DGRAM) as here,
        socket.socket(request.param, socket.SOCK_DGRAM) as there,
    ):
        try:
            here.bind((HERE[request.param], 0))
        except OSError:
            pytest.skip("this machine has no such addresses")
        here.setblocking(False)
        widen(here)
        there.connect(here.getsockname())
        yield here, there


@pytest.mark.parametrize("reader", READERS)
def test_datagrams_come_whole_in_order_with_their_sender(pair, reader):
    here, there = pair
    assert isinstance(datagrams(here), BatchReader if sys.platform == "linux" else SingleReader)
    sent = [b"", b"/a", bytes(DATAGRAM_BYTES), *(b"%d" % number for number in range(50))]
    for packet in sent:
        there.send(packet)
    found, has_more = reader(here).read()
    assert [packet for packet, _, _ in found] == sent
    assert {address for _, address, _ in found} == {there.getsockname()}
    assert not has_more


@pytest.mark.parametrize("reader", READERS)
def test_a_burst_of_more_than_one_read_loses_nothing(pair, reader):
    here, there = pair
    sent = [b"%d" % number for number in range(2 * AT_ONCE + 5)]
    for packet in sent:
        there.send(packet)
    hears, found = reader(here), []
    for _ in range(2):
        some, has_more = hears.read()
        assert len(some) == AT_ONCE
        assert has_more
        found += some
    found += hears.read()[0]
    assert [packet for packet, _, _ in found] == sent
    assert hears.read() == ([], False)
    assert hears.dropped == 0


@on_linux
@pytest.mark.parametrize("pair", [socket.AF_INET], indirect=True)
def test_the_kernel_drops_what_muted_senders_send_and_nothing_else(pair):
    here, there = pair
    hears, port = datagrams(here), there.getsockname()[1]
    others = [("127.0.0.2", port), ("127.0.0.1", port + 1), ("127.0.0.1", port - 1)]
    for muted in (others, [*others, there.getsockname()], []):
        mute(here, muted)
        there.send(b"%d" % len(muted))
    assert [packet for packet, _, _ in hears.read()[0]] == [b"3", b"0"]
    assert hears.dropped == 1


def begin_stamping(here: socket.socket, there: socket.socket) -> None:
    """Wait until the kernel stamps what arrives: it begins to some time after it was asked to."""
    ending = time.monotonic() + 10.0
    while time.monotonic() < ending:
        there.send(b"probe")
        time.sleep(0.02)
        reading_ns = time.monotonic_ns()
        found, _ = datagrams(here).read()
        if all(arrived_ns < reading_ns - 5_000_000 for _, _, arrived_ns in found):
            return
    pytest.fail("the kernel stamps nothing")


@on_linux
def test_the_stamp_is_the_time_of_arrival_and_not_of_reading(pair):
    here, there = pair
    begin_stamping(here, there)
    times = []
    for _ in range(3):
        before = time.monotonic_ns()
        there.send(b"now")
        times.append((before, time.monotonic_ns()))
        time.sleep(0.02)
    found, _ = datagrams(here).read()
    for (before, after), (_, _, arrived_ns) in zip(times, found, strict=True):
        assert before - 1_000_000 < arrived_ns < after + 1_000_000  # the clocks' common error


def turns_of_others(read: Callable[[], object]) -> int:
    """How often another thread, which is always ready, gets to run during a call."""
    interval, count, ending = sys.getswitchinterval(), itertools.count(), threading.Event()

    def work() -> None:
        while not ending.is_set():
            next(count)
            time.sleep(0.0)  # lets go of the GIL

    thread = threading.Thread(target=work)
    thread.start()
    sys.setswitchinterval(10.0)  # nobody is made to let go of it
    try:
        before = next(count)
        read()
        return next(count) - before - 1
    finally:
        sys.setswitchinterval(interval)
        ending.set()
        thread.join()


@on_linux
def test_no_busy_thread_comes_between_the_datagrams_of_a_burst(pair):
    # Each time it did, the rest of the burst waited for its turn.
    here, there = pair
    hears = datagrams(here)
    turns = []
    for _ in range(20):
        for number in range(AT_ONCE):
            there.send(b"%d" % number)
        turns.append(turns_of_others(hears.read))
    # A thread that asked for the GIL before the interval was set may still get it, and keep it
    # for some turns, where the machine is busy.
    assert turns.count(0) >= 15
