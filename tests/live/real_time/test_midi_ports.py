"""MIDI from other programs, through JACK's MIDI system."""

import contextlib
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from types import SimpleNamespace

import pytest
from moves import Moves

from yehu_server.core.midi.events import DISCONNECT, MESSAGE
from yehu_server.errors import DeviceError
from yehu_server.live.audio.output import OutputOptions
from yehu_server.live.midi import input_process
from yehu_server.live.midi.feed import MidiFeed
from yehu_server.live.midi.input_process import Inputs
from yehu_server.live.midi.midi_inputs import MidiInputs, MidiOptions
from yehu_server.live.midi.ports import StableNames, is_opened
from yehu_server.live.midi.routes import Router
from yehu_server.live.options import PartOptions, ServeOptions
from yehu_server.live.server import Server
from yehu_server.params.table import FINGERS
from yehu_server.playing.options import PlayingOptions

RATE, PERIOD = 48000, 1024
LISTENS_AFTER_S = 0.2  # JACK reports a connection before it passes messages on
SOON_S = 60.0  # ports are polled every half a second

# Orders on stdin: "open CLIENT PORT", "close CLIENT", "send CLIENT HEX ...".
SENDER = """
import collections, os, sys, jack
clients = {}
class Sender:
    def __init__(self, name, port):
        self.client = jack.Client(name, no_start_server=True)
        self.port, self.waiting = self.client.midi_outports.register(port), collections.deque()
        self.client.set_process_callback(self.process)
        self.client.activate()
    def process(self, frames):
        self.port.clear_buffer()
        while self.waiting:
            self.port.write_midi_event(0, self.waiting.popleft())
for line in sys.stdin:
    order, name, *words = line.split()
    if order == "open":
        clients[name] = Sender(name, " ".join(words))
    elif order == "close":
        clients.pop(name).client.close()
    else:
        clients[name].waiting.append(bytes.fromhex("".join(words)))
    print("done", flush=True)
os._exit(0)
"""


class Program:
    """Another program that sends MIDI."""

    def __init__(self, code: str, environment: dict[str, str]) -> None:
        self._process = subprocess.Popen(
            [sys.executable, "-c", code],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
            env=environment,
        )

    def send(self, order: str) -> None:
        self._process.stdin.write(order + "\n")
        self._process.stdin.flush()
        assert self._process.stdout.readline() == "done\n"

    def kill(self) -> None:
        self._process.kill()
        with contextlib.suppress(OSError):
            self._process.stdin.close()
        self._process.stdout.close()
        self._process.wait()


class Witness:
    """A server on the silent clock that hears MIDI; its messages, and what is moved."""

    def __init__(self, until: Callable, **midi: object) -> None:
        self._until = until
        self.said: list[tuple[float, str]] = []
        options = ServeOptions(
            output=OutputOptions(device="null", rate=RATE),
            midi=MidiOptions(**{"api": "jack", **midi}),
            osc=("127.0.0.1", 0),
            parts=[PartOptions(PlayingOptions(settings=(("/playing/variation", 0.0),)))],
        )
        self.server = Server(options, lambda line: self.said.append((time.monotonic(), line)))
        self._moves = Moves(self.server.instrument)
        self.server.start()
        self.player = self.server.player

    def hears(self, words: str, within_s: float = SOON_S) -> float:
        """Wait for a line since `forget`; return when it last came."""

        def found() -> float | None:
            return next((at for at, line in list(self.said) if words in line), None)

        at = self._until(found, words, within_s)
        if words.endswith("is connected"):
            time.sleep(LISTENS_AFTER_S)
        return at

    def forget(self) -> None:
        self.said.clear()
        self._moves.seen()

    def applied(self) -> dict[str, tuple[int, float, int]]:
        """Frame, target and ramp of the last move of each parameter."""
        time.sleep(0.05)
        return {move.address: (move.frame, move.target, move.ramp) for move in self._moves.seen()}

    def comes_to(self, pitch: float | None) -> None:
        """Wait until what is posted is played."""
        self._until(lambda: self.player.pitch == pitch, f"the pitch to be {pitch}", SOON_S)

    def plays(self, pitch: float | None, program: Program, order: str) -> None:
        """Send until it plays: on a busy machine JACK loses messages."""

        def played() -> bool:
            program.send(order)
            time.sleep(0.1)
            return self.player.pitch == pitch

        self._until(played, f"{order} to play {pitch}", 5.0)


# JACK without real-time rights is sometimes late and then loses messages: hence periods of 20 ms.
@pytest.fixture(scope="module")
def jack(jackd):
    jackd.start(PERIOD)
    return jackd


@pytest.fixture
def sender(jack) -> Iterator[Program]:
    program = Program(SENDER, jack.environment)
    yield program
    program.kill()


@pytest.fixture(scope="module")
def witness(jack, until) -> Iterator[Callable[..., Witness]]:
    assert jack.pid
    interval = sys.getswitchinterval()
    with contextlib.ExitStack() as ending:

        def make(**midi: object) -> Witness:
            made = Witness(until, **midi)
            ending.callback(made.server.stop)
            return made

        yield make
    sys.setswitchinterval(interval)


@pytest.fixture(scope="module")
def shared_witness(witness) -> Witness:
    return witness()


@pytest.fixture
def listening(shared_witness, until) -> Witness:
    """A server that hears all ports, once those of earlier tests are gone."""
    until(lambda: not shared_witness.server.midi.connected, "earlier ports to be gone", SOON_S)
    shared_witness.forget()
    return shared_witness


@pytest.fixture
def keys(listening, sender) -> Iterator[tuple[Witness, Program]]:
    """A server that hears a keyboard."""
    sender.send("open keyboard out")
    listening.hears("MIDI: keyboard:out is connected")
    yield listening, sender
    listening.forget()
    sender.kill()
    listening.hears("MIDI: keyboard:out is gone")


# ---------------------------------------------------------------- what is played


def test_the_default_mapping_reaches_the_instrument(keys, until):
    heard, keyboard = keys
    applied = {}

    def moves(data: str, address: str) -> float:
        """Send until a message moves a parameter; return where to. A busy JACK loses messages."""
        applied.clear()

        def moved() -> bool:
            keyboard.send(f"send keyboard {data}")
            time.sleep(0.1)
            applied.update(heard.applied())
            return address in applied

        until(moved, f"{data} to move {address}", 5.0)
        return applied[address][1]

    of_80 = moves("90 4a 50", "/bow/pressure")
    assert heard.player.pitch == 74.0
    assert abs(applied["/bow/speed"][1]) == pytest.approx(0.2, rel=1e-3)
    presses = {
        n: applied[f"/finger/{n}/press"][1] for n in FINGERS if f"/finger/{n}/press" in applied
    }
    finger = max(presses, key=presses.get)  # which one lands depends on what was played before
    assert presses[finger] == pytest.approx(1.5)
    place = applied[f"/finger/{finger}/position"][1]

    assert moves("e0 7f 7f", f"/finger/{finger}/position") > place  # the wheel up: two semitones
    assert heard.player.pitch == 76.0
    assert moves("d0 7f", f"/finger/{finger}/press") == pytest.approx(5.0)
    assert abs(moves("b0 10 7f", "/bow/speed")) > 0.21

    # Reset all controllers.
    assert abs(moves("b0 79 00", "/bow/speed")) == pytest.approx(0.2, rel=1e-3)
    assert applied[f"/finger/{finger}/press"][1] == pytest.approx(1.5)
    assert heard.player.pitch == 74.0

    assert moves("80 4a 40", "/bow/side") == 0.0
    assert heard.player.pitch is None
    assert 0.0 < moves("90 4a 01", "/bow/pressure") < of_80  # of velocity 1, and 80

    for mode in ("7b", "78"):  # all notes off, all sound off
        assert moves("90 4a 60", "/bow/speed") != 0.0
        assert heard.player.pitch == 74.0
        assert moves(f"b0 {mode} 00", "/bow/side") == 0.0
        assert heard.player.pitch is None


# ---------------------------------------------------------------- ports that come and go


def test_a_port_that_vanishes_takes_its_notes_with_it(keys):
    heard, keyboard = keys
    heard.plays(69.0, keyboard, "send keyboard 90 45 60")
    heard.forget()
    keyboard.send("close keyboard")
    heard.hears("MIDI: keyboard:out is gone; its notes are ended")
    heard.comes_to(None)
    _, target, ramp = heard.applied()["/bow/speed"]
    assert target == 0.0
    assert ramp < 0.1 * RATE
    assert heard.server.midi.connected == []

    heard.forget()
    keyboard.send("open keyboard out")
    heard.hears("MIDI: keyboard:out is connected")
    heard.plays(67.0, keyboard, "send keyboard 90 43 60")
    heard.plays(None, keyboard, "send keyboard 80 43 60")


# ---------------------------------------------------------------- names


def test_a_port_has_the_same_name_whenever_it_is_there(subtests):
    for names, stable in [
        ([], []),
        (["Keystep:Keystep MIDI 1 24:0"], ["Keystep MIDI 1"]),
        (["Keystep:Keystep MIDI 1 128:0"], ["Keystep MIDI 1"]),
        (["Midi Through:Midi Through Port-0 14:0"], ["Midi Through Port-0"]),
        (["LPK25 0"], ["LPK25"]),
        (["LPK25 0", "LPK25 1"], ["LPK25", "LPK25 #2"]),
        (["A:out", "B:out"], ["A:out", "B:out"]),
        (["IAC Driver Bus 1"], ["IAC Driver Bus"]),
        (["  spaced  "], ["spaced"]),
        (["x"] * 3, ["x", "x #2", "x #3"]),
        (["7"], ["7"]),
        (["琴 1:琴 MIDI 1 20:0"], ["琴 1:琴 MIDI 1"]),
    ]:
        with subtests.test(names=names, stable=stable):
            assert StableNames().of(names) == stable


def test_ports_are_wanted_by_words_of_their_name(subtests):
    for name, patterns, wanted in [
        ("Keystep MIDI", [], True),
        ("Midi Through Port-0", [], False),
        ("MIDI THRU", [], False),
        ("Breakthrough", [], True),
        ("Midi Through Port-0", ["through"], True),
        ("Keystep MIDI", ["key midi"], True),
        ("Keystep MIDI", ["piano", "STEP"], True),
        ("Keystep MIDI", ["key piano"], False),
    ]:
        with subtests.test(name=name, patterns=patterns, wanted=wanted):
            assert is_opened(name, patterns, others=not patterns) is wanted


def feed() -> MidiFeed:
    """A feed whose messages nobody takes."""
    ring = SimpleNamespace(post=lambda *_event: True)
    return MidiFeed([ring], Router([], 1), message=MESSAGE, disconnect=DISCONNECT)


class Studio:
    """A MIDI system with a keyboard and a synthesizer; what is done and reported."""

    name = "studio"

    def __init__(self) -> None:
        self.there = ["keys", "synth"]
        self.done: list[tuple[object, ...]] = []
        self.is_owned = False  # by another program

    def inputs(self, *patterns: str) -> Inputs:
        inputs = Inputs(self, feed(), {"patterns": patterns, "virtual": None, "api": None})
        inputs._system = self
        return inputs

    def reported(self) -> list[tuple[object, ...]]:
        """What was reported since the last call."""
        reported, self.done = [each for each in self.done if len(each) > 1], []
        return reported

    def ports(self) -> list[str]:
        return self.there

    def left(self) -> set[str]:
        return set()

    def open(self, full_name: str, _name: str, _receive: Callable) -> Callable[[], None]:
        if self.is_owned:
            raise DeviceError(full_name)
        self.done.append(("opens",))
        return lambda: None

    def send(self, event: str, **details: object) -> None:
        self.done.append((event, details))


def test_a_port_is_tried_again_where_it_cannot_be_opened(monkeypatch):
    studio = Studio()
    studio.inputs("key").poll()
    assert [step for step, *_ in studio.done] == ["opens", "appeared"]
    studio.done, studio.is_owned = [], True
    inputs = studio.inputs("key")
    for _ in range(5):
        inputs.poll()
    assert [step for step, *_ in studio.done] == ["refused"]  # once, for some seconds
    monkeypatch.setattr(input_process, "AGAIN_S", 0.0)
    inputs.poll()
    assert [step for step, *_ in studio.done] == ["refused"]  # unreported
    studio.is_owned = False
    inputs.poll()
    assert [step for step, *_ in studio.done[1:]] == ["opens", "appeared"]
    studio.done, studio.is_owned = [], True
    inputs.poll()
    assert studio.done == []


def test_a_name_that_no_port_has_is_reported_once_and_heard_when_it_comes():
    studio = Studio()
    inputs = studio.inputs("KEY", "breath")
    for _ in range(3):
        inputs.poll()
    missing = {"pattern": "breath", "present": ["keys", "synth"]}
    assert studio.reported() == [("appeared", {"port": "keys", "number": 0}), ("missing", missing)]
    studio.there = ["keys", "breath"]
    inputs.poll()
    assert studio.reported() == [("appeared", {"port": "breath", "number": 1})]
    studio.there = ["keys"]
    inputs.poll()
    assert studio.reported() == [("vanished", {"port": "breath"})]
    said = []
    player = SimpleNamespace(learning=SimpleNamespace())
    ports = MidiInputs([player], MidiOptions(), SimpleNamespace(inherited=[]), [0], said.append)
    for _ in range(2):  # the MIDI system begins anew
        ports.on_event({"event": "missing", **missing})
    assert said == ["MIDI: no input matches 'breath' yet (there are: keys, synth)"]


@pytest.mark.parametrize(
    ("options", "line"),
    [
        (MidiOptions(), "MIDI: no keyboard found: no JACK server; looking again now and then"),
        (MidiOptions(("keys", "breath")), "MIDI: no keyboard named keys or breath found: no JACK"),
        (MidiOptions(virtual="me"), "MIDI: no keyboard found, and no port me made: no JACK"),
    ],
)
def test_where_there_is_no_midi_the_cause_is_said(options, line):
    said = []
    player, memory = SimpleNamespace(learning=SimpleNamespace()), SimpleNamespace(inherited=[])
    ports = MidiInputs([player], options, memory, [0], said.append)
    ports.on_event({"event": "none", "reason": "no JACK server"})
    assert said[0].startswith(line)
    assert ports.problem == "no JACK server"


# ---------------------------------------------------------------- without a MIDI system


def plays_on(osc, program: Program) -> bool:
    """Send a note; return whether it plays."""
    program.send("send keyboard 90 45 60")
    time.sleep(0.1)
    return osc.status()["note"] > 68.0


@pytest.mark.slow
def test_without_a_midi_system_it_is_useful_and_one_that_comes_is_found(
    jackd, serve, sender, until
):
    jackd.start(PERIOD)
    jackd.stop()
    server = serve("--midi-api", "jack", "--audio-device", "null")
    osc = server.osc()
    server.said("MIDI: no keyboard found")
    osc.send("/note", 67, 90)
    until(lambda: osc.status()["note"] > 66.0, "OSC to play", 2.0)
    jackd.restart()
    sender.send("open keyboard out")
    server.said("MIDI: keyboard:out is connected", 10.0)
    time.sleep(LISTENS_AFTER_S)
    until(lambda: plays_on(osc, sender), "MIDI to play", 5.0)
    assert server.end() == 0


@pytest.mark.slow
def test_when_the_midi_system_dies_osc_plays_on_and_midi_comes_back(jackd, serve, until, tmp_path):
    jackd.start(PERIOD)
    first = Program(SENDER, jackd.environment)
    server = serve("--midi-api", "jack", "--capture", tmp_path / "take.jsonl")
    osc = server.osc()
    server.said("playing on system")
    try:
        first.send("open keyboard out")
        server.said("MIDI: keyboard:out is connected", SOON_S)
        time.sleep(LISTENS_AFTER_S)
        until(lambda: plays_on(osc, first), "MIDI to play", 5.0)
        jackd.kill()
        server.said("MIDI: keyboard:out gone; notes are ended", 5.0)
        until(lambda: osc.status()["note"] == -1.0, "the note's end", 2.0)
        osc.send("/note", 67, 90)
        until(lambda: osc.status()["note"] > 66.0, "OSC to play", 2.0)
        osc.send("/note", 67, 0)
    finally:
        first.kill()
    said = len(server.lines)
    jackd.restart()
    second = Program(SENDER, jackd.environment)
    try:
        second.send("open keyboard out")
        server.said("MIDI: keyboard:out is connected", 10.0, said)
        time.sleep(LISTENS_AFTER_S)
        until(lambda: plays_on(osc, second), "MIDI to play again", 5.0)
    finally:
        second.kill()
    assert server.end() == 0
