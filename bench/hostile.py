"""Two players beside hostile senders: notes lost, late, ping, memory, for each kind of sender.

    .venv/bin/python bench/hostile.py [--seconds N] [--kind NAME ...] [--save FILE.json]

Each kind of sender (`attacks.py`) meets a new server, which plays without a device in its own
process; the sender runs in another. A hundred times a second a player begins a note, ends the one
before and pings, by UDP; another one does so by MIDI, through a JACK server that is started for it.
That one's messages are counted where they are sent, where they are taken by the callback, and where
they came after their frame. Memory is that of the server process alone, sampled; this needs Linux.
"""

import contextlib
import itertools
import socket
import statistics
import threading
import time
from collections.abc import Iterator
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any

import report
from attacks import HOST, HOSTILE, KINDS
from load import SPAWN, MidiOut, dummy_jack
from rich.console import Console
from rich.table import Table

from yehu_server.core.engine.mailbox import MIDI_INPUTS
from yehu_server.live.osc.packets import pack, unpack

RATE, PERIOD = 48000, 256
EVERY_S = 0.01  # between a note and the next
ACQUAINTED_S = 1.5  # the player alone, before the attack
FOUND_S = 1.0  # until a MIDI output is found
RECOVERS_S = 20.0  # at most, until all pings are answered
PITCHES = 24
LOWEST = 62  # the player's notes; hostile ones are lower


# ---------------------------------------------------------------- the server


def serve(pipe: Any, has_midi: bool) -> None:
    """Serve until asked to stop; answer each request with the notes received and the status."""
    from yehu_server.live.audio.devices import NULL
    from yehu_server.live.audio.output import OutputOptions
    from yehu_server.live.midi.midi_inputs import MidiOptions
    from yehu_server.live.options import ServeOptions
    from yehu_server.live.server import Server

    output = OutputOptions(device=NULL, rate=RATE)
    midi = MidiOptions(api="jack") if has_midi else None
    options = ServeOptions(output=output, midi=midi, osc=(HOST, 0))
    playing = Server(options, lambda _line: None)
    notes: list[tuple[float, float]] = []
    begin = playing.player.key_on

    def key_on(note: float, velocity: float, **more: Any) -> None:
        notes.append((note, velocity))
        begin(note, velocity, **more)

    vars(playing.player)["key_on"] = key_on
    playing.start()
    pipe.send(playing.osc.port)
    mail = playing.instrument._rig["mail"][0]  # noqa: SLF001
    while pipe.recv():
        counts = {
            "taken": int(mail["drained"][MIDI_INPUTS, 0]),
            "dropped": int(mail["dropped"][MIDI_INPUTS, 0]),
            "late": int(mail["late"][MIDI_INPUTS]),
            "latest": int(mail["most_late"][MIDI_INPUTS]),
            "notes": int(playing.instrument.midi["notes_of"][0]),
        }
        pipe.send((list(notes), playing.status(), counts))
    playing.stop()


class Served:
    """A server in another process."""

    def __init__(self, *, has_midi: bool = False) -> None:
        self._pipe, there = SPAWN.Pipe()
        self.process = SPAWN.Process(target=serve, args=(there, has_midi), daemon=True)
        self.process.start()
        there.close()
        self.port = int(self._pipe.recv())

    def counts(self) -> tuple[list[tuple[float, float]], dict[str, Any], dict[str, int]]:
        """The notes received so far by OSC, in order; the status; and what is counted of MIDI."""
        self._pipe.send(True)
        notes, status, midi = self._pipe.recv()
        return notes, status, midi

    def bytes(self) -> int:
        """The process's private memory; 0 where the system does not report it."""
        with contextlib.suppress(OSError):
            for line in Path(f"/proc/{self.process.pid}/status").read_text().splitlines():
                if line.startswith("RssAnon"):
                    return int(line.split()[1]) << 10
        return 0

    def stop(self) -> None:
        """End it."""
        with contextlib.suppress(OSError):
            self._pipe.send(False)
        self.process.join(10.0)
        if self.process.is_alive():
            self.process.kill()
            self.process.join()


# ---------------------------------------------------------------- the player


class Playing:
    """Two players: one by UDP, who pings, too, and measures how long answers take; one by MIDI.

    `midi`: without it, nobody plays by MIDI.
    """

    def __init__(self, port: int, midi: Any = None) -> None:
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.connect((HOST, port))
        self._socket.settimeout(0.1)
        self._ending = threading.Event()
        self._sent: dict[int, float] = {}
        self.notes: list[tuple[float, float]] = []
        self.pings_s: list[float] = []
        self._midi = midi
        self.midi_notes = 0
        works = (self._play, self._play_midi, self._hear)
        self._threads = [threading.Thread(target=work) for work in works]
        self._is_playing = True
        for thread in self._threads:
            thread.start()

    @property
    def unanswered(self) -> int:
        """Pings without an answer yet."""
        return len(self._sent)

    def finish(self) -> None:
        """Stop playing, and wait for the pings still unanswered."""
        if self._ending.is_set():
            return
        self._is_playing = False
        for thread in self._threads[:2]:
            thread.join()
        deadline = time.monotonic() + RECOVERS_S
        while self._sent and time.monotonic() < deadline:
            time.sleep(0.01)
        self._ending.set()
        self._threads[2].join()
        self._socket.close()

    def _paced(self) -> Iterator[int]:
        """Count, every EVERY_S, while it plays."""
        began = time.monotonic()
        for number in itertools.takewhile(lambda _: self._is_playing, itertools.count()):
            yield number
            time.sleep(max(0.0, began + (number + 1) * EVERY_S - time.monotonic()))

    def _play(self) -> None:
        for number in self._paced():
            steps, pitch = divmod(number, PITCHES)
            note = float(LOWEST + pitch), 1.0 + steps % 127
            self._socket.send(pack("/yehu/note", *note))
            if self.notes:
                self._socket.send(pack("/yehu/note/off", self.notes[-1][0]))
            self.notes.append(note)
            self._sent[number] = time.monotonic()
            self._socket.send(pack("/yehu/ping", number))

    def _play_midi(self) -> None:
        for number in self._paced() if self._midi is not None else ():
            self._midi.send([0x90, LOWEST + number % PITCHES, 90])
            self._midi.send([0x80, LOWEST + (number - 1) % PITCHES, 0])
            self.midi_notes = number + 1

    def _hear(self) -> None:
        while not self._ending.is_set():
            try:
                packet = self._socket.recv(1 << 16)
            except OSError:
                continue
            (message,) = unpack(packet)
            if message.address == "/yehu/pong":
                (number,) = message.arguments
                self.pings_s.append(time.monotonic() - self._sent.pop(number))


@dataclass
class Figures:
    """The effect of one kind of sender on the players."""

    midi_notes: int
    midi_lost: int
    midi_dropped: int  # messages, by a full ring; others that are lost JACK has lost
    midi_late: int
    midi_latest_ms: float
    notes: int
    lost: int
    hostile_notes: int
    unanswered: int
    ping_median_ms: float
    ping_99_ms: float
    ping_worst_ms: float
    growth_mb: float
    kept_mb: float  # what is left of the growth at the end
    system_dropped: int  # packets, of any sender


def measured(name: str, seconds: float, served: Served, output: Any = None) -> Figures:
    """Play beside one kind of sender, by MIDI to an output, too; measure its effect."""
    before, status, midi = served.counts()
    playing = Playing(served.port, output)
    attacker = SPAWN.Process(target=KINDS[name], args=(served.port, seconds))
    try:
        time.sleep(ACQUAINTED_S)
        idle_bytes = most_bytes = served.bytes()
        playing.pings_s.clear()
        attacker.start()
        end = time.monotonic() + 2.0 * seconds + RECOVERS_S
        while attacker.is_alive() and time.monotonic() < end:
            most_bytes = max(most_bytes, served.bytes())
            time.sleep(0.005)
        playing.finish()
        most_bytes = max(most_bytes, served.bytes())
        notes, after, played = served.counts()
    finally:
        attacker.kill()
        attacker.join()
        playing.finish()
    notes = notes[len(before) :]
    own = [note for note in notes if note[0] != HOSTILE]
    left = iter(playing.notes)
    in_order = sum(note in left for note in own)
    pings = sorted(playing.pings_s) + [RECOVERS_S] * playing.unanswered
    return Figures(
        midi_notes=playing.midi_notes,
        midi_lost=playing.midi_notes - played["notes"] + midi["notes"],
        midi_dropped=played["dropped"],
        midi_late=played["late"],
        midi_latest_ms=1e3 * played["latest"] / RATE,
        notes=len(playing.notes),
        lost=len(playing.notes) - in_order,
        hostile_notes=len(notes) - len(own),
        unanswered=playing.unanswered,
        ping_median_ms=1e3 * statistics.median(pings),
        ping_99_ms=1e3 * pings[int(0.99 * len(pings))],
        ping_worst_ms=1e3 * pings[-1],
        growth_mb=1e-6 * (most_bytes - idle_bytes),
        kept_mb=1e-6 * (served.bytes() - idle_bytes),
        system_dropped=after["osc_dropped"] - status["osc_dropped"],
    )


def main() -> None:
    """Measure and print everything."""
    parser = report.options(__doc__)
    parser.add_argument("--seconds", type=float, default=10.0, help="of each (default: 10)")
    parser.add_argument("--kind", nargs="*", choices=KINDS, help="(default: all)")
    arguments = parser.parse_args()
    table = Table("")
    for field in fields(Figures):
        table.add_column(field.name.replace("_", " "), overflow="fold")
    figures = {}
    for name in arguments.kind or KINDS:
        with dummy_jack(PERIOD, RATE):
            served, output = Served(has_midi=True), MidiOut("player")
            try:
                time.sleep(FOUND_S)
                got = figures[name] = asdict(measured(name, arguments.seconds, served, output))
            finally:
                served.stop()
                output.close()
        table.add_row(name, *(f"{value:.1f}".removesuffix(".0") for value in got.values()))
    Console(width=150).print(table)
    report.save(arguments.save, figures, seconds=arguments.seconds)


if __name__ == "__main__":
    main()
