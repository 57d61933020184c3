"""A real server by OSC: delays, bursts, who may speak, start and stop."""

import contextlib
import errno
import os
import socket
from functools import partial

import pytest
from wire import f32

from yehu_server.errors import DeviceError
from yehu_server.live.network import why_not
from yehu_server.live.osc.listening_sockets import open_both
from yehu_server.live.web.server import OSCQUERY, listen

HOST = "127.0.0.1"


@pytest.mark.parametrize("kind", ["udp", "prefixed", "slip"])
def test_a_burst_of_messages_all_reach_the_instrument(live, busy, kind, wire):
    client = live.client() if kind == "udp" else live.stream(slip=kind == "slip")
    count = 3_000  # with more waiting a sender is muted
    if live.ports.traffic.buffer_bytes < count * 768:
        pytest.skip(f"the system grants {live.ports.traffic.buffer_bytes} bytes only")
    packets = [wire.message("/yehu/bow/position", 0.04 + 5e-5 * n) for n in range(count)]
    applied = int(live.instrument.meters()["applied"])
    with contextlib.nullcontext() if kind == "udp" else busy():
        for packet in packets:
            client.take(packet)
        client.sync()
    live.settle()
    assert live.handler.counts.messages == count + 1
    assert live.ports.traffic.kernel_drops == 0
    assert int(live.instrument.meters()["applied"]) - applied == count
    assert live.instrument.dropped_events == 0
    assert live.target("/bow/position") == f32(0.04 + 5e-5 * (count - 1))
    assert live.is_well()


def test_who_asks_for_much_at_once_keeps_nobody_else_waiting(live, wire):
    greedy, other = live.client(), live.client()
    greedy.take(wire.bundle(None, *[wire.message("/yehu/params")] * 800))
    live.wait_frames(1000)
    other.sync()
    assert live.handler.counts.messages < 800


def test_stopping_while_notes_and_clients_are_there_ends_all(make_live):
    live = make_live()
    client, stream = live.client(), live.stream()
    client.send("/subscribe", 60)
    client.wait_for("/subscribed")
    stream.send("/note", 67, 90)
    stream.send("/record/start", "take")
    stream.wait_for("/record/started")
    live.wait_frames(4800)  # the fixture checks that nothing is left


# ---------------------------------------------------------------- an address in use


def test_an_address_in_use_for_oscquery_is_reported_with_others():
    hint = "in use; play beside it: --http :9011"
    with socket.create_server((HOST, 0)) as taken, pytest.raises(DeviceError, match=hint):
        listen(OSCQUERY, *taken.getsockname())


def test_an_address_of_another_machine_is_refused_with_those_of_this_one():
    elsewhere = ("192.0.2.1", 9000)
    for open_one in open_both, partial(listen, OSCQUERY):
        with pytest.raises(DeviceError, match=r"; this machine has .*127\.0\.0\.1"):
            open_one(*elsewhere)


@pytest.mark.parametrize("kind", [socket.SOCK_DGRAM, socket.SOCK_STREAM])
def test_others_are_not_named(kind) -> None:
    with socket.socket(socket.AF_INET, kind) as other:
        other.bind((HOST, 0))
        if kind == socket.SOCK_STREAM:
            other.listen()
        port = other.getsockname()[1]
        with pytest.raises(DeviceError, match=r"in use$"):
            open_both(HOST, port)


def test_on_windows_no_port_of_another_program_is_taken(monkeypatch) -> None:
    with monkeypatch.context() as windows:
        windows.setattr(os, "name", "nt")  # there SO_REUSEADDR would take it
        udp, tcp = open_both(HOST, 0)
    with udp, tcp:
        assert tcp.getsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR) == 0


def test_windows_says_of_an_address_in_use_what_others_say() -> None:
    theirs = "Only one usage of each socket address (protocol/network address/port) is permitted"
    assert why_not(OSError(errno.EADDRINUSE, theirs)) == os.strerror(errno.EADDRINUSE).lower()


def test_a_running_server_is_named(live) -> None:
    with pytest.raises(DeviceError, match="in use by a running yehu-server"):
        open_both(HOST, live.server.osc.port)
