"""A client of JACK that sings a file of sound into a port: run as a program, ends after it."""

import os
import sys
import threading
import time

import jack
import numpy as np

PATIENCE_S = 10.0


def sing(server: str, into: str, file: str) -> None:
    """Be the singer."""
    for silence in (jack.set_error_function, jack.set_info_function):
        silence(lambda _message: None)
    sound = np.load(file).astype(np.float32)
    client = jack.Client("singer", servername=server, no_start_server=True)
    port = client.outports.register("out")
    sung, may_sing = 0, threading.Event()

    @client.set_process_callback
    def process(frames: int) -> None:
        nonlocal sung
        out = port.get_array()
        out[:] = 0.0
        if may_sing.is_set() and sung < len(sound):
            part = sound[sung : sung + frames]
            out[: len(part)] = part
            sung += frames

    client.set_shutdown_callback(lambda _status, _reason: None)
    client.activate()
    deadline = time.monotonic() + PATIENCE_S
    while not client.get_ports(into):
        assert time.monotonic() < deadline
        time.sleep(0.005)
    client.connect("singer:out", into)
    may_sing.set()
    while sung < len(sound):
        time.sleep(0.01)
    os._exit(0)  # JACK may hang where its server is gone


if __name__ == "__main__":
    sing(*sys.argv[1:])
