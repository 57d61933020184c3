"""Long streams of MIDI and other events by chance, and what they come to in this process.

Run as a program it writes what some come to: without the JIT, in plain Python.
"""

import json
import random
import re
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from interpreted import Leader
from live.page import streams as calls

from yehu_server.core.engine.ensemble import Ensemble
from yehu_server.core.engine.rig import RIG
from yehu_server.core.midi import events
from yehu_server.core.midi.packing import packed
from yehu_server.core.midi.tables import TABLE_SLOTS
from yehu_server.core.player import commands
from yehu_server.core.player.parameter_indices import INDEX
from yehu_server.params.table import find
from yehu_server.playing.calibration_store import calibration_for
from yehu_server.playing.mapping import Mapping, load, shipped_mappings
from yehu_server.playing.options import PlayingOptions
from yehu_server.playing.preset_folders import Presets
from yehu_server.playing.tables import Controls, make_tables
from yehu_server.playing.tuning import EQUAL, RangePolicy, Tuning, read_tuning

RATE, BLOCK = 48000.0, 128
_mail, _mail_at = (RIG.fields or {})["mail"][:2]
# Number of the word of an instrument's memory that lets its commands be reported.
REPORTING = (_mail_at + (_mail.fields or {})["reporting"][1]) // 8
OWN_CALLS = 0.05  # a chance after each
NATIVE_FUNCTIONS = 40  # frames from one step to the next
SYSEX, CLOCK = (0xF0, 0x7E, 0x09, 0xF7), (0xF8,)
TUNINGS = {"equal": EQUAL, "seven": read_tuning(Path("chaozhou-seven-equal"))}
Event = tuple[int, int, float, float]  # kind, index, value, other


@dataclass(frozen=True)
class Step:
    """A call of the C interface: its name, frame and arguments; and the events that it posts."""

    name: str
    frame: int
    arguments: tuple[Any, ...]
    events: tuple[Event, ...]

    def line(self) -> str:
        """The step for programs: its name, frame and arguments."""
        numbers = [repr(number) for number in self.arguments]
        count = [str(len(numbers))] if self.name == "midi" else []
        return " ".join([self.name, str(self.frame), *count, *numbers])


@dataclass
class Stream:
    """Steps, and the tables that they take."""

    steps: list[Step]
    tables: list[Any]

    @property
    def frames(self) -> int:
        """Length in whole blocks, with some after the last step."""
        return (self.steps[-1].frame // BLOCK + 4) * BLOCK

    def write(self, folder: Path) -> tuple[Path, Path]:
        """Write steps and tables to files for programs."""
        steps, tables = folder / "steps", folder / "tables"
        steps.write_text("".join(f"{step.line()}\n" for step in self.steps))
        tables.write_bytes(b"".join(each.tobytes() for each in self.tables))
        return steps, tables


# In text with a character for each byte: whole messages, and a reset inside one, which comes first.
WHOLE = re.compile("[\x80-\xbf\xe0-\xef][\0-\x7f]{2}|[\xc0-\xdf][\0-\x7f]|\xff")
INSIDE = re.compile("([\x80-\xbf\xe0-\xef][\0-\x7f]?|[\xc0-\xdf])\xff")


def messages_of(data: Sequence[int]) -> list[int]:
    """The messages in some bytes that are posted (``midi.packing.packed``)."""
    text, was = bytes(byte for byte in data if not 0xF8 <= byte < 0xFF).decode("latin-1"), ""
    while was != text:
        was, text = text, INSIDE.sub("\xff\\1", text)
    return [packed(whole.encode("latin-1")) for whole in WHOLE.findall(text)]


class Maker:
    """Makes the stream of a seed."""

    def __init__(self, seed: int, parts: int) -> None:
        self._chance = random.Random(seed)
        some = {str(n): calls.some_mapping(self._chance, str(n)) for n in range(parts)}
        shipped = {name: load(name) for name in shipped_mappings()}
        self._mappings: dict[str, Mapping] = some | shipped
        self._parts = calls.Streams(seed, [*some, *shipped])
        self._controls, self._presets = Controls(), Presets()
        self._options: dict[str, Any] = {}
        self._frame, self._key = 0, 60.0
        self.stream = Stream([], [])
        for _ in range(parts):
            self._options = self._some_options()
            self._map()
            self._post(events.START, 0, 0.0, 0.0)
            for name, *arguments in self._parts.next():
                self._call(name, arguments)
                if self._chance.random() < OWN_CALLS:
                    self._call_own()

    def _some_options(self) -> dict[str, Any]:
        chance = self._chance
        options = {
            "mapping": chance.choice([*self._mappings]),
            "tuning": chance.choice([*TUNINGS]),
            "a4": chance.choice([440.0, 440.0, 392.0, 480.5]),
            "policy": chance.choice(["transpose", "transpose", "clamp", "skip"]),
            "programs": chance.random() < 0.5,
            "channels": chance.choice([None, None, None, [0, 9]]),
        }
        if chance.random() < 0.2:
            options["preset"] = chance.choice(calls.PRESETS)
        return options

    def _call_own(self) -> None:
        """Call what no page calls: named controls, holds, and a beginning anew."""
        chance = self._chance
        kind = chance.randrange(4)
        if kind < 2:
            number, argument = (
                self._controls.number(chance.choice(calls.ADDRESSES)),
                chance.random(),
            )
            self._step("control", (number, argument), (events.CONTROL, number, argument, 0.0))
        elif kind == 2:
            param = chance.choice(calls.FREE)
            self._post(commands.HOLD, INDEX[param.address], chance.uniform(param.lo, param.hi), 0.0)
        else:
            self._post(events.RELEASE_ALL, 0, 1.0, 0.0)
            self._post(events.START, 0, 1.0, 0.0)

    def _step(self, name: str, arguments: tuple[Any, ...], *posted: Event) -> None:
        self._frame += NATIVE_FUNCTIONS
        self.stream.steps.append(Step(name, self._frame, arguments, posted))

    def _post(self, kind: int, index: int, value: float, other: float) -> None:
        event = (kind, index, float(value), float(other))
        self._step("post", event, event)

    def _map(self) -> None:
        options, programs = self._options, self._presets.programs()
        tuning: Tuning = TUNINGS[options["tuning"]]
        made = make_tables(
            self._mappings[options["mapping"]],
            self._controls,
            start=self._presets.load(options["preset"]).values.items()
            if "preset" in options
            else (),
            tuning=tuning,
            a4=options["a4"],
            policy=RangePolicy(options["policy"]),
            received=options["channels"],
            programs=programs if options["programs"] else None,
        )
        self.stream.tables.append(made)
        count = len(self.stream.tables)
        self._frame += 2 * BLOCK  # those before are in use
        self._step("map", (count - 1,), (events.TABLES_TO, count % TABLE_SLOTS, 0.0, 0.0))

    def _call(self, name: str, given: list[Any]) -> None:
        *arguments, _frame = given
        if name == "midi":
            self._midi(arguments[0], given[2])
        elif name == "remap":
            self._options["mapping"] = given[0]
            self._map()
        elif name == "applyTuning":
            self._options["tuning"] = self._chance.choice([*TUNINGS])
            self._map()
        elif name == "applyPreset":
            for address, value in self._presets.load(given[0]).values.items():
                self._post(events.LOAD, INDEX[address], value, 0.0)
        else:
            self._by_hand(name, arguments)

    def _midi(self, data: Sequence[int], port: int) -> None:
        if port != 0:
            message = (events.MESSAGE, packed(data, port), 0.0, 0.0)
            self._post(*message)
            return
        chance = self._chance.random()
        if chance < 0.1:
            data = (*SYSEX, *data, *CLOCK)
        elif chance < 0.2 and len(data) > 1:
            data = (data[0], *CLOCK, *data[1:], 0)  # a byte more than there is
        last = self.stream.steps[-1]
        if chance > 0.6 and last.name == "midi":  # several at a time
            self.stream.steps.pop()
            self._frame -= NATIVE_FUNCTIONS
            data = (*last.arguments, *data)
        posted = [(events.MESSAGE, message, 0.0, 0.0) for message in messages_of(data)]
        self._step("midi", tuple(data), *posted)

    def _by_hand(self, name: str, given: list[Any]) -> None:
        if name == "write":
            address, value = given
            self._post(events.SET, INDEX[address], find(address).clamped(value), 0.0)
        elif name == "fingerOn":
            self._key = given[1]
            self._post(events.FINGER_ON, -1, given[1], given[2])
        elif name == "noteOff":
            self._post(events.NOTE_OFF, -1, self._key, 0.0)
        elif name == "slide":
            self._post(commands.SLIDE, 0, given[0], 0.0)
        elif name == "draw":
            self._post(commands.DRAW, 0, *given)
        elif name == "endPortNotes":
            self._post(events.DISCONNECT, given[0], 0.0, 0.0)
        elif name in ("lift", "release"):
            self._post(commands.LIFT if name == "lift" else commands.RELEASE, 0, 0.0, 0.0)
        elif name in ("endNotes", "panic"):
            self._post(events.RELEASE_ALL, 0, float(name == "panic"), 0.0)
            if name == "panic":
                self._post(commands.STOP, 0, 1.0, 0.0)


def stream_of(seed: int, parts: int) -> Stream:
    """The stream of a seed: the same in every process."""
    return Maker(seed, parts).stream


def interpreted(stream: Stream) -> list[list[Event]]:
    """What each event of a stream comes to, interpreted alone."""
    leader = Leader()
    leader.begin_part(PlayingOptions().tables(Controls()))
    found = [leader.interpret(0, events.START, 0, 0.0, 0.0)]
    tables = iter(stream.tables)
    for step in stream.steps:
        for kind, *fields in step.events:
            if kind == events.TABLES_TO:
                leader.tables[fields[0]] = next(tables)[0]
            found.append(leader.interpret(step.frame, kind, *fields))
    return found


def played(stream: Stream) -> np.ndarray:
    """Play a stream by the server's instrument; return its record [shape=(1,), dtype=RIG]."""
    ensemble = Ensemble([PlayingOptions().spec(RATE, calibration_for(RATE))], is_live=True)
    first = ensemble.first
    first.begin_part(PlayingOptions().tables(Controls()))
    first.report_commands()
    assert first.post(events.START)
    tables = iter(stream.tables)
    out = np.zeros((BLOCK, 2), np.float32)
    steps = list(reversed(stream.steps))
    for done in range(0, stream.frames, BLOCK):
        while steps and steps[-1].frame < done + BLOCK:
            step = steps.pop()
            for kind, index, value, other in step.events:
                if kind == events.TABLES_TO:
                    assert first.midi["tables"] == (index - 1) % TABLE_SLOTS
                    first.tables[index] = next(tables)[0]
                assert first.post(kind, frame=step.frame, index=index, value=value, other=other)
        ensemble.process(out)
    assert np.isfinite(out).all()
    return first._rig.copy()


def commands_in(rig: np.ndarray) -> np.ndarray:
    """The commands that were applied, in order: ndarray [shape=(commands,), dtype=COMMAND]."""
    mail = rig["mail"][0]
    assert mail["unreported"] == 0
    assert mail["dropped"].sum() == 0
    return rig["reports"][0, : mail["reported"][0]]


def record_in(memory: Path) -> np.ndarray:
    """The record of an instrument, in a file with all its memory."""
    return np.fromfile(memory, np.uint8)[: RIG.itemsize].view(RIG)


def numbers(found: Sequence[Sequence[Event]]) -> Iterator[list[float]]:
    """All commands of `interpreted`, as lists."""
    return (list(command) for requested in found for command in requested)


if __name__ == "__main__":
    output, parts, *seeds = sys.argv[1:]
    made = {seed: interpreted(stream_of(int(seed), int(parts))) for seed in seeds}
    Path(output).write_text(json.dumps(made))
