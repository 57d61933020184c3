"""What MIDI over JACK loses, repeats and damages before this program hears of it.

    .venv/bin/python bench/jack_midi.py [--seconds 60] [--busy 3] [--save bench/results/NAME.json]

RtMidi sends 1,400 numbered messages a second. RtMidi and JACK-Client each receive them, in
processes of their own beside some that compute; JACK runs with its dummy driver, asynchronous as by
default and synchronous (`jackd --sync`). Nothing of this program takes part.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import time
from collections import Counter
from typing import Any

import report
from load import JACK, compute, dummy_jack, helper

RATE, PERIOD = 48000, 64
BURST, EVERY_S, SETTLED_S = 7, 0.005, 0.5  # messages at once, between them, after the last
KINDS = {0x80: 3, 0x90: 3, 0xB0: 3, 0xE0: 3, 0xD0: 2}  # lengths, by status
NUMBERS = 1 << 14  # that three bytes hold; two hold fewer, and are not numbered
KEPT = 12  # damaged messages that are shown


def send(seconds: float, answer: Any) -> None:
    """Send bursts that put other kinds into each place of JACK's buffer; answer with how many."""
    import rtmidi

    out = rtmidi.MidiOut(rtmidi.API_UNIX_JACK, name="sender")
    out.open_virtual_port("out")
    answer.send(None)
    answer.recv()
    count, due = 0, time.monotonic()
    end = due + seconds
    while due < end:
        for _ in range(BURST):
            kind = list(KINDS)[count % len(KINDS)]
            out.send_message([kind, count & 0x7F, count >> 7 & 0x7F][: KINDS[kind]])
            count += 1
        due += EVERY_S
        time.sleep(max(0.0, due - time.monotonic()))
    time.sleep(SETTLED_S)
    answer.send(count)
    answer.recv()
    os._exit(0)


def receive_by_rtmidi(answer: Any) -> None:
    """Answer with all messages that a callback of RtMidi is given."""
    import rtmidi

    midi = rtmidi.MidiIn(rtmidi.API_UNIX_JACK, name="by RtMidi")
    heard: list[bytes] = []
    midi.set_callback(lambda event, _data: heard.append(bytes(event[0])))
    midi.open_port(next(i for i, name in enumerate(midi.get_ports()) if "sender" in name))
    _answer_when_asked(heard, answer)


def receive_by_jack(answer: Any) -> None:
    """The same by JACK-Client, which ends where JACK says that there is no message."""
    import jack  # type: ignore[import-untyped]

    client = jack.Client("by JACK-Client", servername=JACK, no_start_server=True)
    heard: list[bytes] = []
    port = client.midi_inports.register("in")
    client.set_process_callback(
        lambda _frames: heard.extend(bytes(data) for _, data in port.incoming_midi_events())
    )
    client.activate()
    client.connect(client.get_ports("sender", is_output=True)[0], port)
    _answer_when_asked(heard, answer)


def _answer_when_asked(heard: list[bytes], answer: Any) -> None:
    answer.send(None)
    answer.recv()
    answer.send(heard)
    answer.recv()
    os._exit(0)


def be_busy(answer: Any) -> None:
    """Compute until it is ended."""
    compute()
    answer.recv()
    os._exit(0)


def judged(sent: int, heard: list[bytes]) -> dict[str, Any]:
    """How many messages of those that are numbered are lost and repeated, and which are damaged."""
    damaged = [m for m in heard if not m or KINDS.get(m[0]) != len(m) or max(m[1:]) > 0x7F]
    numbers, last = [], -1
    for message in heard:
        if len(message) == 3 and KINDS.get(message[0]) == 3:
            step = (message[1] | message[2] << 7) - last
            last += (step + NUMBERS // 2) % NUMBERS - NUMBERS // 2
            numbers.append(last)
    numbered = sum(KINDS[list(KINDS)[n % len(KINDS)]] == 3 for n in range(sent))
    return {
        "sent": numbered,
        "lost": numbered - len(set(numbers)),
        "repeated": len(numbers) - len(set(numbers)),
        "damaged": len(damaged),
        "such as": [f"{m.hex(' ')}: {n}" for m, n in Counter(damaged).most_common(KEPT)],
    }


def measure(arguments: argparse.Namespace) -> dict[str, dict[str, Any]]:
    rows = {}
    receivers = {"RtMidi": receive_by_rtmidi, "JACK-Client": receive_by_jack}
    for mode, words in {"asynchronous": (), "synchronous": ("--sync",)}.items():
        with dummy_jack(PERIOD, RATE, *words), contextlib.ExitStack() as stack:
            sender = stack.enter_context(helper(send, arguments.seconds))
            sender.recv()
            ears = {name: stack.enter_context(helper(work)) for name, work in receivers.items()}
            for ear in ears.values():
                ear.recv()
            others = [stack.enter_context(helper(be_busy)) for _ in range(arguments.busy)]
            sender.send(None)
            sent = sender.recv()
            for name, ear in ears.items():
                ear.send(None)
                rows[f"{name}, {mode}"] = judged(sent, ear.recv())
            for process in (sender, *ears.values(), *others):
                process.send(None)  # all at once, or JACK waits for those that are gone
    return rows


if __name__ == "__main__":
    seconds, others = (60.0, "seconds of each mode"), (3, "processes that compute beside them")
    report.run(__doc__, measure, seconds=seconds, busy=others)
