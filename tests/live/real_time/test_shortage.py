"""Helpers that end while the system has no room for new ones; a server that is stopped."""

import os
import resource
import signal
import socket
import time
from pathlib import Path

import pytest

from yehu_server.live.osc.packets import pack

pytestmark = pytest.mark.slow

DEVICE = "system, JACK Audio Connection Kit"
if not hasattr(resource, "prlimit"):
    pytest.skip("another process's limits are Linux's", allow_module_level=True)


def module_of(pid: int) -> str:
    module = Path(f"/proc/{pid}/cmdline").read_bytes().split(b"\0")[-2].decode()
    return ".".join(module.split(".")[-2:])


def helpers(server) -> dict[str, int]:
    """The server's helper processes, by module."""
    found = {}
    for pid in server.family():
        try:
            found[module_of(pid)] = pid
        except (OSError, IndexError):  # just ended, or just begun
            continue
    return found


def allow_files(pid: int, files: int) -> int:
    """Limit the open files of a process from now on; return its limit before."""
    soft, hard = resource.prlimit(pid, resource.RLIMIT_NOFILE)
    resource.prlimit(pid, resource.RLIMIT_NOFILE, (files, hard))
    return soft


def begun(jackd, serve, until):
    """A server with both helpers, and a client of it."""
    jackd.start(512)
    server = serve("--midi-api", "jack", panel=True)
    osc = server.osc()
    server.said(f"playing on {DEVICE}")
    until(
        lambda: {"audio.stream", "midi.input_process"} <= set(helpers(server)), "its helpers", 10.0
    )
    return server, osc


def test_helpers_that_end_while_there_are_no_files_come_back_when_there_are(jackd, serve, until):
    server, osc = begun(jackd, serve, until)
    pid, before, said = server.process.pid, helpers(server), len(server.lines)
    allowed = allow_files(pid, 3)
    for name in ("audio.stream", "midi.input_process"):
        os.kill(before[name], signal.SIGKILL)
    server.said("no sound: the audio process cannot be started: too many open files", 10.0, said)
    server.said("MIDI inputs: too many open files; trying again", 10.0, said)
    time.sleep(2.0)  # time for some more tries
    for about in ("audio process", "MIDI inputs"):
        assert len([line for line in server.lines[said:] if about in line]) == 1
    frame = osc.status()["frame"]
    until(lambda: osc.status()["frame"] > frame + 4800, "time to go on", 5.0)
    assert "too many open files" in osc.status()["problem"]

    allow_files(pid, allowed)
    server.said(f"playing on {DEVICE}", 15.0, said)
    until(lambda: "midi.input_process" in helpers(server), "its MIDI process", 15.0)
    assert not any("Traceback" in line for line in server.lines)
    assert osc.status()["device_losses"] == 1
    assert server.end() == 0


def test_clients_that_come_while_there_are_no_files_are_let_in_when_there_are(jackd, serve):
    jackd.start(512)
    server = serve("--midi-api", "none")
    osc = server.osc()
    ports = {
        "osc": int(server.said(r"OSC at [\d.]+:(\d+)")[1]),
        "http": int(server.said(r"http://[\d.]+:(\d+)")[1]),
    }
    allowed = allow_files(server.process.pid, 3)
    clients = {
        name: socket.create_connection(("127.0.0.1", port), 20.0) for name, port in ports.items()
    }
    try:
        time.sleep(0.3)
        assert osc.ask("/ping", 7, last="/pong") == {"/pong": [7]}
        allow_files(server.process.pid, allowed)
        ping = pack("/yehu/ping", 8)
        clients["osc"].sendall(len(ping).to_bytes(4, "big") + ping)
        clients["http"].sendall(b"GET /?HOST_INFO HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n")
        assert b"/yehu/pong" in clients["osc"].recv(100)
        assert clients["http"].recv(100).startswith(b"HTTP/1.1 200")
    finally:
        for client in clients.values():
            client.close()
    assert not any("Traceback" in line for line in server.lines)
    assert len([line for line in server.lines if "Too many" in line]) <= 1
    assert server.end() == 0


def test_a_server_that_is_stopped_for_a_while_loses_no_helper(jackd, serve, until):
    server, osc = begun(jackd, serve, until)
    before = helpers(server)
    for _ in range(2):
        os.kill(server.process.pid, signal.SIGSTOP)
        time.sleep(2.5)
        os.kill(server.process.pid, signal.SIGCONT)
        frame = osc.status()["frame"]
        until(lambda frame=frame: osc.status()["frame"] > frame + 9600, "time to go on", 5.0)
    assert helpers(server) == before
    status = osc.status()
    assert (status["device"], status["device_losses"]) == (DEVICE, 0)
    assert not any("gone" in line for line in server.lines)
    assert server.end() == 0
