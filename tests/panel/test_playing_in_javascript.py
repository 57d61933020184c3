"""The page's player posts the wishes that the server's posts, whatever is played."""

from __future__ import annotations

import json
import math
import os
import random
import subprocess
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from interpreted import Leader
from panel import streams

from yehu_server.panel import facts, styles
from yehu_server.params.preset import morph
from yehu_server.params.table import find
from yehu_server.player.wishes import BEGIN, END, STOP
from yehu_server.playing.live import LivePlayer
from yehu_server.playing.mapping import Mapping, load, shipped_mappings
from yehu_server.playing.messages import MidiPlayer
from yehu_server.playing.presets import Presets
from yehu_server.playing.range_policy import RangePolicy
from yehu_server.playing.style import Style
from yehu_server.playing.tuning import EQUAL, Tuning, read_tuning
from yehu_server.playing.wishes import Wishes

STREAMS, MANY_STREAMS = 2_000, 10_000
SOME_MAPPINGS = 60

Wish = tuple[float, ...]  # frame, kind, index, value, other


class Recorder(Leader):
    """Stands for an instrument, and records what is wished of it, as soon as it is posted."""

    rate, frame = streams.RATE, 0
    is_live = False

    def __init__(self) -> None:
        super().__init__()
        self.wishes: list[Wish] = []
        self.posted = 0

    def post(self, kind, *, frame=None, index=0, value=0.0, other=0.0) -> bool:
        self.posted += 1
        at = -self.posted if frame is None else frame  # what is for now has a frame of its own
        for wish in self.interpret(at, kind, index, value, other):
            self.wishes.append((-1 if frame is None else frame, *wish))
        return True

    def take_in(self) -> None:
        """Nothing waits."""

    def meters(self) -> dict[str, float]:
        return {"drained": self.posted, "next_frame": math.inf}

    def target(self, address: str) -> float:
        return find(address).default


@dataclass(frozen=True)
class Chosen(Style):
    """A style that receives some channels only."""

    channels: frozenset[int] | None = None

    def midi(self, wishes: Wishes, channels: set[int] | None = None) -> MidiPlayer:
        assert channels is None
        return super().midi(wishes, self.channels)


class Server(LivePlayer):
    """A live player with the methods of the page's; a frame of None is now."""

    def __init__(self, style: Chosen, mappings: dict[str, Mapping]) -> None:
        recorder = Recorder()
        super().__init__(recorder, style, delay_ms=0.0, wishes=style.wishes([recorder]))
        self._mappings = mappings
        self._key = 0.0

    def _at(self, frame):
        return None if frame is None else super()._at(frame)

    def _after_all(self, frame):
        return None if frame is None else super()._after_all(frame)

    def call(self, method: str, *values: Any) -> None:
        """Do what the page's player does by this method."""
        *given, frame = values
        if method == "midi":
            self._hear(*values)
        elif method == "noteOn":
            _id, self._key, velocity = given
            self.note_on(self._key, velocity * 127.0, frame=frame)
        elif method == "noteOff":
            self.note_off(self._key, frame=frame)
        elif method == "hold":
            self._wishes.write(*given, frame=frame, hold=True)
        elif method == "lift":
            self._wishes.lift(frame=frame)
        elif method == "applyPreset":
            self.load(self.presets.load(given[0]).values, frame=frame)
        elif method == "applyMorph":
            one, other = map(self.presets.load, given[:2])
            self.load(morph(one, other, given[2]), frame=frame)
        elif method == "applyMapping":
            self.remap(self._mappings[given[0]], frame=frame)
        elif method == "applyTuning":  # a style of the server's does not change
            self._wishes._tuning, self._wishes._a4 = TUNINGS[given[0]], frame
            self.instrument.furnish(self._midi._tables())
        else:
            name = {"letGoOf": "let_go_of", "endNotes": "end_notes"}.get(method, method)
            getattr(self, name)(*given, frame=frame)

    def _hear(self, data: list[int], frame: int | None, port: int) -> None:
        self._midi.receive(data, frame=self._at(frame), port=port)


def tunings() -> dict[str, Tuning]:
    scale, keys = Path("chaozhou-seven-equal"), Path("chaozhou-keys")
    return {
        "equal": EQUAL,
        scale.name: read_tuning(scale),
        f"{scale}, {keys}": read_tuning(scale, keys),
    }


TUNINGS = tunings()


@pytest.fixture(scope="module")
def mappings() -> dict[str, Mapping]:
    """The shipped mappings, and others that have whatever a mapping can have."""
    chance = random.Random(1)
    names = [f"some {number}" for number in range(SOME_MAPPINGS)]
    shipped = {name: load(name) for name in shipped_mappings()}
    return shipped | {name: streams.some_mapping(chance, name) for name in names}


def expected(stream: dict[str, Any], mappings: dict[str, Mapping], presets: Presets):
    """What the server's player makes of a stream."""
    given = stream["style"]
    chosen = given["channels"]
    preset = presets.load(given["preset"]).values if "preset" in given else {}
    style = Chosen(
        mapping=mappings[given["mapping"]],
        start=tuple(preset.items()),
        presets=presets,
        programs=given["programs"],
        a4=given["a4"],
        tuning=TUNINGS[given["tuning"] or "equal"],
        policy=RangePolicy(given["policy"]),
        channels=None if chosen is None else frozenset(chosen),
    )
    server = Server(style, mappings)
    for call in stream["calls"]:
        server.call(*call)
    positions = [position for _, position, _ in server.bindings()]
    return {
        "wishes": server.instrument.wishes,
        "sound": list(server.sound().values()),
        "positions": [-1.0 if position is None else position for position in positions],
    }


def normal(wishes: Iterable[Wish]) -> list[Wish]:
    """Wishes without ends of keys that are not held, and those that end together in order."""
    found: list[Wish] = []
    held: set[tuple[float, float]] = set()
    ending: list[Wish] = []
    for wish in wishes:
        frame, kind, channel, key, other = wish
        if kind == BEGIN:
            held.add((channel, key))
        elif kind == STOP and key != 0.0:
            held.clear()
        if kind != END:
            found.append(wish)
            continue
        if (channel, key) in held:
            held.discard((channel, key))
            ending.append((frame, kind, channel, key, 1.0))
        if other == 0.0 and ending:
            *others, last = sorted(ending)
            found += (*others, (*last[:4], 0.0))
            ending = []
    return found


def is_same(told: Sequence[Any], wanted: Sequence[Any]) -> bool:
    if len(told) != len(wanted):
        return False
    return np.allclose(np.array(told), np.array(wanted), rtol=1e-12, atol=1e-12)


def test_the_page_wishes_what_the_server_wishes(node, playing, mappings, everything, tmp_path):
    made = streams.Streams(2, list(mappings))
    played = [made.next() for _ in range(MANY_STREAMS if everything else STREAMS)]
    own = {name: styles.mapping(mapping) for name, mapping in mappings.items()}
    lines = [json.dumps(each) for each in (own, *played)]
    result = subprocess.run(
        [node, Path(__file__).with_name("playing.mjs"), playing],
        input="\n".join(lines),
        capture_output=True,
        text=True,
        check=False,
    )
    assert result.returncode == 0, result.stderr
    told = [json.loads(line) for line in result.stdout.splitlines()]
    presets = Presets(tmp_path)
    kinds = set()
    for number, (stream, page) in enumerate(zip(played, told, strict=True)):
        server = expected(stream, mappings, presets)
        wishes = normal(zip(*[iter(page["wishes"])] * 5, strict=True))
        assert is_same(wishes, normal(server["wishes"])), (number, stream)
        assert is_same(page["sound"], server["sound"]), (number, stream)
        assert is_same(page["positions"], server["positions"]), (number, stream)
        kinds |= {kind for _, kind, *_ in server["wishes"]}
    assert len(kinds) == len(facts.facts()["kinds"]) - 1  # the page posts no ramps


def test_the_page_s_own_player_has_hands(node, playing):
    result = subprocess.run(
        [node, "--test", Path(__file__).with_name("player.test.mjs")],
        env=os.environ | {"WEB": str(playing)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert result.returncode == 0, result.stdout


def test_the_types_of_the_page_s_player_are_right(playing):
    compiler = Path(__file__).parents[2] / "node_modules" / ".bin" / "tsc"
    if not compiler.exists():
        pytest.skip("npm install has not been run")
    result = subprocess.run(
        [compiler, "--project", playing / "jsconfig.json"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert result.returncode == 0, result.stdout[:2000]
