"""A client of JACK that records the instrument's ports: run as a program, with a server's name.

It reads orders from its input, and confirms each on its output.
"""

import os
import sys
import time

import jack
import numpy as np

RECORDED_S = 60
PATIENCE_S = 10.0


def record(server: str, channels: int) -> None:
    """Be the recorder."""
    for silence in (jack.set_error_function, jack.set_info_function):
        silence(lambda _message: None)
    client = jack.Client("recorder", servername=server, no_start_server=True)
    inputs = [client.inports.register(f"in_{number}") for number in range(channels)]
    samples = np.zeros((channels, RECORDED_S * client.samplerate), np.float32)
    times = np.zeros((samples.shape[1] // client.blocksize + 1, 3), np.int64)
    recorded, blocks, xruns = 0, 0, 0

    @client.set_process_callback
    def process(frames: int) -> None:
        nonlocal recorded, blocks
        if recorded + frames <= samples.shape[1]:
            for channel, port in enumerate(inputs):
                samples[channel, recorded : recorded + frames] = port.get_array()
            times[blocks] = client.last_frame_time, frames, time.monotonic_ns()
            recorded += frames
            blocks += 1

    @client.set_xrun_callback
    def xrun(_delay_us: float) -> None:
        nonlocal xruns
        xruns += 1

    client.set_shutdown_callback(lambda _status, _reason: None)
    client.activate()

    def connect() -> None:
        deadline = time.monotonic() + PATIENCE_S
        while not client.get_ports("yehu-server:out_"):
            assert time.monotonic() < deadline
            time.sleep(0.005)
        for number, port in enumerate(inputs):
            if not client.get_all_connections(port):
                client.connect(f"yehu-server:out_{number}", port)

    print("ready", flush=True)  # noqa: T201
    for line in sys.stdin:
        order, _, what = line.strip().partition(" ")
        answer = {"connect": "connected", "save": "saved", "forget": "forgotten"}.get(order, order)
        if order == "connect":
            connect()
        elif order == "freewheel":
            client.set_freewheel(what == "on")
        elif order == "forget":
            recorded, blocks, xruns = 0, 0, 0
        elif order == "save":
            till, of = recorded, blocks
            np.savez(what, samples=samples[:, :till], times=times[:of], xruns=xruns)
        print(answer, flush=True)  # noqa: T201
    os._exit(0)  # JACK may hang where its server is gone


if __name__ == "__main__":
    record(sys.argv[1], int(sys.argv[2]))
