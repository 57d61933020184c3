"""Streams of calls of a player: whatever hands, MIDI devices and pages may send, by chance."""

import itertools
import random
from functools import partial
from typing import Any

from yehu_server.params.spec import Curve, Param
from yehu_server.params.table import TABLE
from yehu_server.playing import sources
from yehu_server.playing.bind import Bind, Breakpoints
from yehu_server.playing.mapping import Mapping
from yehu_server.playing.mapping_file import MappingFile

Call = list[Any]
FREE = [param for param in TABLE if not param.player_controlled]
ADDRESSES = ("/tilt", "/touch/1")
PRESETS = ("flautando", "ordinary", "pizzicato", "scratch", "sul-tasto", "tremolo", "vibrato")
TUNINGS = ("equal", "chaozhou-seven-equal", "chaozhou-seven-equal, chaozhou-keys")
LEARNED = ("bend", "pressure", "poly-pressure", "cc 1", "cc 1/33", "cc 11", "cc 74", "nrpn 300")
LISTENED = (0, 1, 2, 5, 7, 11, 32, 33, 34, 39, 65, 67, 71, 74, 76, 77, 78, 92, *range(20, 24))
NRPNS = (3, 300)


def some_mapping(chance: random.Random, name: str) -> Mapping:
    """A mapping of any sources, targets, curves and settings."""
    binds = tuple(some_bind(chance) for _ in range(chance.randint(3, 14)))
    start = {
        param.address: chance.uniform(param.lo, param.hi)
        for param in chance.sample(FREE, chance.randint(0, 4))
    }
    return Mapping(name, binds, tuple(start.items()), mpe=chance.random() < 0.3)


def some_bind(chance: random.Random) -> Bind:
    """A bind that a mapping file may have."""
    source = chance.choice(
        [
            *sources.WORDS, *sources.WORDS, *ADDRESSES, *map(sources.nrpn, NRPNS),
            *(sources.control(number) for number in (*LISTENED, 64)),
            *(sources.pair(number) for number in (1, 2, 7)),
        ]
    )  # fmt: skip
    bend = "/playing/bend"
    target = bend if source == sources.BEND else chance.choice(FREE).address
    span = None if chance.random() < 0.3 else some_span(chance, target)
    is_by_range = (source, target, span) == (sources.BEND, bend, None)
    is_of_note = source in sources.OF_ONE_NOTE
    is_address = sources.is_address(source)
    return Bind(
        source,
        target,
        span,
        some_curve(chance, span or ends_of(target)),
        invert=chance.random() < 0.2,
        smoothing_ms=chance.choice([0.0, 0.0, 30.0]),
        channels=() if is_address or chance.random() < 0.8 else (1, chance.randint(2, 16)),
        is_soft=chance.random() < 0.3 and not is_of_note and not is_by_range,
        input_range=(0.0, 127.0) if is_address and chance.random() < 0.5 else (0.0, 1.0),
        is_global=chance.random() < 0.2 and not is_of_note and not is_address,
    )


def some_learned(chance: random.Random, base: str) -> MappingFile:
    """What somebody has taught a shipped mapping."""
    controls = chance.sample(LEARNED, 3)
    targets = chance.sample(FREE, 3)
    binds = tuple(map(partial(learned_bind, chance), controls, targets))
    return MappingFile(base, binds, base=base)


def learned_bind(chance: random.Random, source: str, param: Param) -> Bind:
    """A bind as the page learns it, and perhaps with ends of its own."""
    is_of_note = source in sources.OF_ONE_NOTE
    is_by_range = (source, param.address) == (sources.BEND, "/playing/bend")
    lo = max(param.lo, 0.01) if param.curve is Curve.EXP else param.lo
    spanned = chance.random() < 0.5 and not is_by_range
    return Bind(
        source,
        param.address,
        (chance.uniform(lo, param.hi), chance.uniform(lo, param.hi)) if spanned else None,
        param.curve,
        is_soft=chance.random() < 0.5 and not is_of_note and not is_by_range,
        is_exclusive=True,
        is_global=not is_of_note,
    )


def ends_of(address: str) -> tuple[float, float]:
    param = next(each for each in FREE if each.address == address)
    return param.lo, param.hi


def some_span(chance: random.Random, address: str) -> tuple[float, float]:
    lo, hi = ends_of(address)
    return chance.uniform(lo, hi), chance.uniform(lo, hi)


def some_curve(chance: random.Random, ends: tuple[float, float]) -> Curve | Breakpoints:
    curve = chance.choice([Curve.LIN, Curve.S, Curve.EXP, None])
    if curve is Curve.EXP and min(ends) <= 0.0:
        return Curve.LIN
    if curve is not None:
        return curve
    inner = sorted({chance.uniform(0.01, 0.99) for _ in range(chance.randint(0, 4))})
    fractions = [chance.choice([0.0, 0.5, 1.0, chance.random()]) for _ in range(len(inner) + 2)]
    return Breakpoints(tuple(zip((0.0, *inner, 1.0), fractions, strict=True)))


class Streams:
    """Makes one stream after another; the same for the same seed."""

    def __init__(self, seed: int, mappings: list[str]) -> None:
        self._chance = random.Random(seed)
        self._mappings = mappings

    def next(self) -> list[Call]:
        """A stream: calls of JavaScript's methods, each with its frame."""
        chance = self._chance
        self._is_timed = chance.random() < 0.7
        self._frame = 0
        self._in_hand = False
        self._ports = chance.choice([(0,), (0,), (0, 1, 2)])
        self._own_channels = chance.choice([(0,), (0, 1, 9), (0, 1, 2, 15), (0, 14, 15)])
        self._keys = chance.sample(range(55, 101), 3)
        calls = [["remap", chance.choice(self._mappings), self._at()]]
        calls.append(["applyTuning", chance.choice(TUNINGS)])
        while len(calls) < 40:
            calls += self._some()
        return calls

    def _at(self) -> int | None:
        """The frame of the next call, which may be that of the one before."""
        return self._frame if self._is_timed else None

    def _some(self) -> list[Call]:
        chance = self._chance
        self._frame += chance.choice([0, 0, 1, 1, 480, 100_000])
        kind = chance.random()
        if kind < 0.40:
            return [self._note()]
        if kind < 0.85:
            return self._midi()
        if kind < 0.88:
            return [["midi", self._noise(), self._at(), chance.choice(self._ports)]]
        if kind < 0.94:
            return [self._by_hand()]
        return [self._of_style()]

    def _send(self, status: int, *data: int) -> Call:
        channel = self._chance.choice(self._own_channels)
        return self._send_on(channel, self._chance.choice(self._ports), status, *data)

    def _send_on(self, channel: int, port: int, status: int, *data: int) -> Call:
        return ["midi", [status | channel, *data], self._at(), port]

    def _note(self) -> Call:
        chance = self._chance
        key = chance.choice(self._keys)
        velocity = chance.choice([0, *(chance.randint(1, 127) for _ in range(5))])
        return self._send(chance.choice([0x80, 0x90, 0x90]), key, velocity)

    def _midi(self) -> list[Call]:
        """Anything but notes; a control change, mostly."""
        chance = self._chance
        value = chance.choice([0, 64, 127, chance.randrange(128)])
        kind = chance.randrange(14)
        if kind < 4:
            return [self._parameter, self._parameter, self._pedal, self._zones][kind]()
        key = chance.choice(self._keys)
        messages = [
            (0xE0, chance.randrange(128), value),
            (0xD0, value),
            (0xA0, key, value),
            (0xC0, chance.randrange(10)),
            (0xB0, 64, value),
            (0xB0, chance.randrange(120, 128), value),
        ]
        control = (0xB0, chance.choice(LISTENED), value)
        return [self._send(*[*messages, *4 * [control]][kind - 4])]

    def _parameter(self) -> list[Call]:
        """A registered or non-registered parameter, mostly whole, and what it is set to."""
        chance = self._chance
        channel = chance.choice(self._own_channels)
        port = chance.choice(self._ports)
        nrpn = chance.choice(NRPNS)
        selected = chance.choice(
            [((101, 0), (100, 0)), ((101, 0), (100, 6)), ((99, nrpn >> 7), (98, nrpn & 127))]
        )
        entries = [(6, chance.choice([0, 2, 7, 15, 127])), (38, chance.randrange(128))]
        entries += [(96, 0), (97, 0)]
        some = [*selected, *chance.sample(entries, chance.randint(1, 3))]
        if chance.random() < 0.1:
            chance.shuffle(some)
        return [self._send_on(channel, port, 0xB0, *pair) for pair in some]

    def _pedal(self) -> list[Call]:
        """A key under the pedal, and something in between, mostly."""
        chance = self._chance
        channel, port = chance.choice(self._own_channels), chance.choice(self._ports)
        key = chance.choice(self._keys)
        between = [(0xB0, 120, 0), (0xB0, 123, 0), (0xB0, 121, 0), (0x90, key, 80), (0x80, key, 0)]
        some = [
            (0xB0, 64, 127), (0x90, key, 90), (0x80, key, 0), chance.choice(between), (0xB0, 64, 0)
        ]  # fmt: skip
        if chance.random() < 0.2:
            chance.shuffle(some)
        return [self._send_on(channel, port, *data) for data in some]

    def _zones(self) -> list[Call]:
        """Two MPE zones, which may overlap; bends and a note of a master and of a member."""
        chance = self._chance
        port, key = chance.choice(self._ports), chance.choice(self._keys)
        calls = []
        for master in chance.sample([0, 15], chance.randint(1, 2)):
            members = chance.choice([0, 1, 2, 13, 15])
            for control, value in ((101, 0), (100, 6), (6, members)):
                calls.append(self._send_on(master, port, 0xB0, control, value))
        for channel in chance.sample([0, 1, 2, 13, 14, 15], 3):
            calls.append(self._send_on(channel, port, 0xE0, 0, chance.randrange(128)))
            calls.append(self._send_on(channel, port, 0x90, key, 90))
        return calls

    def _noise(self) -> list[int]:
        """Bytes that may be no message, or one that is of no concern."""
        chance = self._chance
        first = chance.choice([*range(0x80, 0x100, 8), 0xFF, 0xFF, 0xF8, 0x40])
        rest = (chance.choice([0, 64, 127, 128, 255]) for _ in itertools.repeat(None))
        return [first, *itertools.islice(rest, chance.randint(0, 3))][chance.random() < 0.02 :]

    def _by_hand(self) -> Call:
        chance, at = self._chance, self._at()
        self._in_hand, was_in_hand = not self._in_hand, self._in_hand
        kind = chance.randrange(8)
        if kind < 4 and was_in_hand:
            return ["noteOff", "hand", at]
        if kind < 4:
            return ["fingerOn", "hand", round(chance.uniform(50.0, 100.0), 2), chance.random(), at]
        self._in_hand = was_in_hand
        param = chance.choice(TABLE)
        return [
            ["slide", chance.uniform(50.0, 100.0), at],
            ["draw", chance.uniform(-3.0, 3.0), chance.uniform(-1.0, 6.0), at],
            [chance.choice(["lift", "release"]), at],
            ["write", param.address, chance.uniform(param.lo - 1.0, param.hi + 1.0), at],
        ][kind - 4]

    def _of_style(self) -> Call:
        chance, at = self._chance, self._at()
        kind = chance.randrange(6)
        if kind == 4:
            self._in_hand = False
        return [
            ["applyPreset", chance.choice(PRESETS), at],
            ["remap", chance.choice(self._mappings), at],
            ["remap", chance.choice(self._mappings), at],
            ["applyTuning", chance.choice(TUNINGS)],
            [chance.choice(["endNotes", "panic"]), at],
            ["endPortNotes", chance.choice(self._ports), at],
        ][kind]
