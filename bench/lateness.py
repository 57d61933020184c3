"""How many events come after their frame, with Python idle and busy, by the delay's handling part.

    .venv/bin/python bench/lateness.py [--seconds N] [--handling MS ...] [--blocks N ...]
                                       [--steady] [--parts N] [--listeners]
                                       [--audio-device NAME] [--save FILE.json]

A server plays in a process of its own. Another process sends it 2,000 OSC and 600 MIDI messages a
second (`load.py`). A busy server also has a thread that computes in Python without a pause. An
event is late where the callback takes it after the frame that it asked for; the callback counts
them by source, and by how much the latest came. Callbacks begun late, and under-runs, show how well
the machine keeps time: an event that was there in time is late, too, where the sound server calls
out of turn. Without --audio-device a JACK server with the dummy driver is started, which has no
real-time rights; so the delay grows by itself. With --steady it stays at what it is by default on a
device that keeps time: a block and the handling part. With --parts several players share the load,
and with --listeners eight OSCQuery clients are sent every change of any value.
"""

import contextlib
import itertools
import time
from dataclasses import dataclass
from typing import Any

import report
from endurance import listen
from load import CARD, compute, helper, loaded, sound_card

from yehu_server.core.engine.mailbox import MIDI_INPUTS, SERVER
from yehu_server.core.engine.warming import warm_up
from yehu_server.live.audio.output import OutputOptions
from yehu_server.live.midi.midi_inputs import MidiOptions
from yehu_server.live.options import PartOptions, ServeOptions
from yehu_server.live.server import Server
from yehu_server.live.web.server import WebOptions
from yehu_server.playing import delay as delays

RATE = 48000
BLOCKS = (64, 128)
HANDLING_MS = (0.0, 0.25, 0.5, 1.0)
SETTLED_S = 3.0  # until ports are found and the delay has settled
SOURCES = {"OSC": SERVER, "MIDI": MIDI_INPUTS}
COUNTS = ("late_callbacks", "underruns", "callbacks")


# ---------------------------------------------------------------- the server


@dataclass(frozen=True)
class Setting:
    """What one row of the table is measured with."""

    device: str
    block: int
    handling_ms: float
    is_steady: bool
    is_busy: bool
    parts: int = 1
    has_listeners: bool = False

    @property
    def jitter_ms(self) -> float | None:
        """The fixed delay; None where the server adapts it."""
        return 1e3 * self.block / RATE + self.handling_ms if self.is_steady else None


def counts(server: Server, *, anew: bool) -> dict[str, int]:
    """The counters of the audio side; with `anew` the latest events are forgotten."""
    meters = server.instrument.meters()
    found = {what: int(meters[what]) for what in COUNTS}
    mails = [player.instruments[0]._rig["mail"][0] for player in server.players]  # noqa: SLF001
    for source, writer in SOURCES.items():
        found[f"{source} taken"] = sum(int(mail["drained"][writer, 0]) for mail in mails)
        found[f"{source} late"] = sum(int(mail["late"][writer]) for mail in mails)
        found[f"{source} latest"] = max(int(mail["most_late"][writer]) for mail in mails)
        if anew:
            for mail in mails:
                mail["most_late"][writer] = 0
    dropped = sum(instrument.dropped_events for instrument in server.ensemble.instruments)
    found["dropped"] = dropped + server.osc.traffic.kernel_drops
    found["delay"] = server.player.delay
    return found


def serve(setting: Setting, pipe: Any) -> None:
    """Serve until asked to stop; answer each request with the counters."""
    delays.HANDLING_MS = setting.handling_ms
    options = ServeOptions(
        output=OutputOptions(device=setting.device, blocksize=setting.block, rate=RATE),
        midi=MidiOptions(),
        osc=("127.0.0.1", 0),
        http=WebOptions(("127.0.0.1", 0)) if setting.has_listeners else None,
        parts=[PartOptions()] * setting.parts,
        jitter_ms=setting.jitter_ms,
    )
    server = Server(options, lambda _line: None)
    server.start()
    if setting.is_busy:
        compute()
    pipe.send((server.osc.port, None if server.web is None else server.web.port))
    while (asked := pipe.recv()) is not None:
        pipe.send(counts(server, anew=asked))
    server.stop()


# ---------------------------------------------------------------- one row


def run(setting: Setting, seconds: float) -> dict[str, Any]:
    """Play under load for some seconds; return the figures of a row."""
    sent = [0]
    with helper(serve, setting) as pipe:
        port, http = pipe.recv()
        listeners = contextlib.nullcontext() if http is None else helper(listen, http)
        with loaded(port, setting.parts), listeners as pages:
            time.sleep(SETTLED_S)
            pipe.send(True)
            before, started = pipe.recv(), time.monotonic()
            time.sleep(seconds)
            pipe.send(False)
            after, lasted = pipe.recv(), time.monotonic() - started
            if pages is not None:
                pages.send(None)
                sent = pages.recv()
        pipe.send(None)
    passed = {what: after[what] - before[what] for what in after}
    callbacks = max(1, passed["callbacks"])
    figures: dict[str, Any] = {"delay, ms": 1e3 * after["delay"] / RATE}
    for source in SOURCES:
        taken = passed[f"{source} taken"]
        figures[f"{source} a second"] = taken / lasted
        figures[f"{source} % late"] = 100.0 * passed[f"{source} late"] / max(1, taken)
        figures[f"{source} latest, ms"] = 1e3 * after[f"{source} latest"] / RATE
    return figures | {
        "dropped": passed["dropped"],
        "% late callbacks": 100.0 * passed["late_callbacks"] / callbacks,
        "% under-runs": 100.0 * passed["underruns"] / callbacks,
        "sent to listeners": sum(sent),
    }


# ---------------------------------------------------------------- the whole


def main() -> None:
    """Measure and print everything."""
    parser = report.options(__doc__)
    parser.add_argument("--seconds", type=float, default=10.0, help="of each row (default: 10)")
    parser.add_argument("--handling", type=float, nargs="+", default=HANDLING_MS, metavar="MS")
    parser.add_argument("--blocks", type=int, nargs="+", default=BLOCKS, metavar="FRAMES")
    parser.add_argument("--steady", action="store_true", help="keep the delay as short as it gets")
    parser.add_argument("--parts", type=int, default=1, help="number of players (default: 1)")
    parser.add_argument("--listeners", action="store_true", help="eight OSCQuery clients listen")
    parser.add_argument("--audio-device", help="see yehu-server devices (default: a dummy)")
    arguments = parser.parse_args()
    warm_up()  # compile before processes wait for each other
    device = arguments.audio_device or CARD
    rows = {}
    for block in arguments.blocks:
        with sound_card(arguments.audio_device, block):
            for handling_ms, is_busy in itertools.product(arguments.handling, (False, True)):
                setting = Setting(
                    device,
                    block,
                    handling_ms,
                    arguments.steady,
                    is_busy,
                    arguments.parts,
                    arguments.listeners,
                )
                name = f"{block} frames, {'busy' if is_busy else 'idle'}, {handling_ms:g} ms"
                rows[name] = run(setting, arguments.seconds)
    report.show(rows, "late events, by the delay's handling part")
    report.save(
        arguments.save,
        rows,
        device=arguments.audio_device or report.NO_CARD,
        seconds=arguments.seconds,
        steady=arguments.steady,
        parts=arguments.parts,
    )


if __name__ == "__main__":
    main()
