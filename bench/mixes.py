"""Players of each kind beside random mixes of all that may be sent, in a time of frames.

Players by MIDI, by OSC (datagrams and a connection) and on a page play a note every 10 ms, the page
half of them 50 ms ahead. Beside them plays a mix: up to 31 pages, of owners and guests, that send
all kinds of commands as fast as they may, now and ahead; up to 20 others by OSC, of either kind,
with up to twice the notes that are admitted, some in bundles for one time; another MIDI input. Or
31 pages send commands of one kind. A note is late by the frames from the one that it was sent for
to the one at which it was applied; one that is not is "ended" where a page's panic came while it
waited, else "lost".
Sockets and the system's scheduling are left out.
"""

import random
import time
from collections.abc import Iterator
from typing import Any

import numpy as np
from attacks import bundle, prefixed

from yehu_server.core.engine.mailbox import MIDI_INPUTS, PAGES, SERVER
from yehu_server.core.engine.rig import ring_place
from yehu_server.core.midi.events import DISCONNECT, MESSAGE
from yehu_server.core.player.commands import BEGIN, DRAW, END, KINDS, SLIDE, STOP, WRITE
from yehu_server.live import traffic_limits as limits
from yehu_server.live.audio.output import shared_memory
from yehu_server.live.midi.feed import MidiFeed, SharedRing
from yehu_server.live.midi.routes import Router
from yehu_server.live.osc.context import CallContext
from yehu_server.live.osc.handler import OscHandler
from yehu_server.live.osc.packets import pack
from yehu_server.live.osc.peers import Framing, Peer
from yehu_server.live.page.guests import OWN, PLAY
from yehu_server.live.page.page_sockets import AT_ONCE, NOW, SETTINGS
from yehu_server.live.page.players import LOWEST, PagePlayers, permitted
from yehu_server.live.page.shared_view import SharedView
from yehu_server.params.table import TABLE
from yehu_server.playing.calibration_store import calibration_for
from yehu_server.playing.options import PlayingOptions
from yehu_server.playing.parts import assemble, player_of
from yehu_server.system.memory import map_all
from yehu_server.util.token_bucket import TokenBucket

RATE = 44100.0
NOTE_S, AHEAD_S = 0.01, 0.05
KEYS = 60  # the players' begin here; those of a mix are lower
# Keys that tell notes apart; those of OSC and pages go up by steps.
MIDI_KEYS, STEP = 60, 0.005
OSC_KEYS, PAGE_KEY = {"OSC, UDP": 121.0, "OSC, TCP": 124.0}, 200.0
MOST_OF_DEADLINE = 0.5


class Page:
    """A page that sends commands of all kinds, or of one, as fast as it may."""

    def __init__(self, number: int, of: int, chance: random.Random, kind: str = "") -> None:
        self.number, self._chance = number, chance
        self._role = chance.choice((OWN, PLAY))
        self._many = chance.choice((1, 20, 300, limits.PAGE_EVENTS))  # of a message
        self._ahead_s = chance.choice((None, 0.0, 0.05, 0.2, 0.5))
        self._weights = [chance.random() ** 3 for _ in KINDS[WRITE:]]
        if kind:
            self._role, self._ahead_s = OWN, 0.2
            self._weights = [float(each == kind) for each in KINDS[WRITE:]]
        self._waiting = np.empty((0, 5))
        at_once = max(AT_ONCE, limits.PAGE_EVENTS_AT_ONCE / of)
        self._bucket = TokenBucket(limits.PAGE_EVENTS_A_SECOND, at_once)

    def play(self, players: PagePlayers, frame: int) -> None:
        """Post what a page may at a frame, as ``live.page.page_sockets`` does."""
        while self._bucket.left(frame / RATE) >= 0.0:
            if not len(self._waiting):
                at = NOW if self._ahead_s is None else frame + round(RATE * self._ahead_s)
                kinds = self._chance.choices(range(WRITE, len(KINDS)), self._weights, k=self._many)
                rows = np.array([self._command(kind, at) for kind in kinds])
                self._waiting, ends = permitted(self._role, rows)
                self._bucket.spend(len(rows) - len(self._waiting))
                if ends:
                    players.leave(self.number, 0)
            some = self._waiting[:AT_ONCE]
            if not players.has_room(self.number, 0, len(some)):
                break
            self._bucket.spend(len(some))
            players.post(self.number, 0, some, 0)
            self._waiting = self._waiting[AT_ONCE:]

    def _command(self, kind: int, frame: float) -> tuple[float, ...]:
        chance = self._chance
        index, value, other = chance.randrange(LOWEST, -LOWEST), chance.choice((0.0, 1.0)), 0.0
        if kind in SETTINGS:
            index = chance.randrange(len(TABLE))
            value = chance.uniform(TABLE[index].lo, TABLE[index].hi)
        elif kind in (BEGIN, END):
            value, other = chance.randrange(KEYS), chance.uniform(62.0, 85.0)
        elif kind in (SLIDE, DRAW):
            value, other = chance.uniform(-1.0, 90.0), chance.uniform(0.0, 6.0)
        spread = 0 if frame == NOW else chance.choice((0, 0, chance.randrange(200)))
        return frame + spread, kind, index, value, other


class Sender(Peer):
    """A sender of OSC, by datagrams or over a connection, that reads no answers."""

    def __init__(self, *, has_connection: bool) -> None:
        self.name = self.host = f"sender {id(self)}"
        self._framing = Framing() if has_connection else None

    @property
    def takes_more(self) -> bool:
        """Whether it reads answers."""
        return False

    def send(self, *packets: bytes) -> None:
        """Leave an answer unread."""

    def play(self, handler: OscHandler, some: list[bytes], frame: int | None = None) -> None:
        """Send messages together, to be handled at once, or as a bundle for a frame is."""
        packet = some[0] if len(some) == 1 else bundle(some)
        packets: Any = [packet]
        if self._framing is not None:
            packets = self._framing.packets(prefixed(packet))
        for each in packets:
            for _ in handler.handle(each, self, frame=frame):
                pass


class Stage:
    """A part on a stage, with all who play it, in a time of frames."""

    def __init__(self, mix: int | str) -> None:
        chance = self._chance = random.Random(mix)  # noqa: S311
        kind = mix if isinstance(mix, str) else ""
        memory, options = shared_memory(), PlayingOptions()
        map_all(memory.buffer)  # as the audio process does
        tuned = calibration_for(RATE)
        self.ensemble, (own,) = assemble([options], RATE, [tuned], memory=memory.buffer)
        self.instrument = self.ensemble.first
        vars(self.instrument)["frame_at"] = lambda _ns: self.ensemble.frame
        player = player_of(0, options, own, delay_ms=0.0)
        self.handler = OscHandler(
            CallContext([player], lambda _group: {}, str, str, print, lambda f: f(), lambda f: f())
        )
        view = SharedView(memory.handle)
        vars(view)["frame_of"] = lambda _ns: self.ensemble.frame
        self._pages = PagePlayers(view, [0])
        ring = SharedRing(memory.buffer, ring_place(MIDI_INPUTS, 0))
        self._feed = MidiFeed([ring], Router([], 1), message=MESSAGE, disconnect=DISCONNECT)
        self._feed.open("keys"), self._feed.open("pads")
        memory.close()
        self._players = {name: Sender(has_connection="TCP" in name) for name in OSC_KEYS}
        for sender in self._players.values():  # before others: they have a queue each
            sender.play(self.handler, [pack("/yehu/ping")])
        count = (31 if kind else chance.choice((1, 6, 31))) if mix else 0
        self._mix = [Page(number + 1, count, chance, kind) for number in range(count)]
        mix = 0 if kind else mix
        self._osc = chance.choice((500.0, 2000.0, 35200.0)) if mix else 0.0  # notes a second
        self._senders = [
            Sender(has_connection=n % 2 == 1) for n in range(chance.choice((1, 4, 20)))
        ]
        self._bundle = chance.choice((1, 20, 200))
        self._pads = chance.choice((0, 100, 1000)) if mix else 0  # MIDI messages a second
        self.asked: dict[str, list[tuple[float, int]]] = {
            who: [] for who in ("MIDI", *OSC_KEYS, "page")
        }

    def send(self, frames: int) -> None:
        """Send all that comes in a block."""
        begin, chance = self.ensemble.frame, self._chance
        for page in self._mix:
            page.play(self._pages, begin)
        for _ in _due(self._pads, begin, frames):
            kind = chance.choice((0x80, 0x90, 0xA0, 0xB0, 0xC0, 0xD0, 0xE0))
            data = [chance.randrange(KEYS), chance.randrange(128)][: 1 + (kind not in (0xC0, 0xD0))]
            self._feed.receive("pads", [kind + chance.randrange(4), *data], 0)
        for n in _due(self._osc / self._bundle, begin, frames):
            at = begin + chance.choice((0, round(0.2 * RATE)))
            notes = [
                _note(chance.randrange(KEYS), chance.randrange(128)) for _ in range(self._bundle)
            ]
            self._senders[n % len(self._senders)].play(self.handler, notes, at)
        for n in _due(1.0 / NOTE_S, begin, frames):
            self._play_note(n, begin)

    def _play_note(self, n: int, frame: int) -> None:
        """Play a note by each door, and end those before them."""
        key = KEYS + n % MIDI_KEYS
        self.asked["MIDI"].append((key, frame))
        self._feed.receive("keys", [0x90, key, 90], 0)
        self._feed.receive("keys", [0x80, KEYS + (n - 1) % MIDI_KEYS, 0], 0)
        for name, sender in self._players.items():
            of_osc = _stepped(OSC_KEYS[name], n)
            self.asked[name].append((of_osc, frame))
            sender.play(
                self.handler, [_note(of_osc, 90), _note(_stepped(OSC_KEYS[name], n - 1), 0)]
            )
        at, of_page = frame + (n % 2) * round(AHEAD_S * RATE), _stepped(PAGE_KEY, n)
        self.asked["page"].append((of_page, at))
        # The note before is yet to come, or this one is.
        rows = [(at, BEGIN, 1, of_page, 72.0), (at, END, 1, _stepped(PAGE_KEY, n - 2), 0.0)]
        self._pages.post(0, 0, np.array(rows), 0)


def _stepped(key: float, n: int) -> float:
    return round(key + n % 512 * STEP, 3)


def _note(key: float, velocity: float) -> bytes:
    return pack("/yehu/note", float(key), float(velocity))


def _due(a_second: float, begin: int, frames: int) -> Iterator[int]:
    """Number what comes so often, of that which comes in some frames."""
    first, end = (-int(-frame * a_second // RATE) for frame in (begin, begin + frames))
    return iter(range(first, end))


def run(mix: int | str, block: int, seconds: float) -> tuple[Stage, np.ndarray, np.ndarray]:
    """Play beside a mix; return the stage, the CPU time of each block, and applied commands."""
    stage, out = Stage(mix), np.zeros((block, 2), np.float32)
    stage.instrument.report_commands()
    stage.ensemble.process(out)
    times, applied = [], []
    for _ in range(round(seconds * RATE / block)):
        stage.send(block)
        start = time.thread_time_ns()
        stage.ensemble.process(out)
        times.append(1e-9 * (time.thread_time_ns() - start))
        applied.append(stage.instrument.applied_commands())
    return stage, np.array(times), np.concatenate(applied)


def figures(mix: int | str, block: int, seconds: float, runs: int) -> dict[str, Any]:
    """Play beside a mix so many times; return a row of the table. Least times count."""
    played = [run(mix, block, seconds) for _ in range(runs)]
    row: dict[str, Any] = {}
    for stage, _, applied in played:
        begun = applied[applied["kind"] == BEGIN]
        panics = applied["frame"][(applied["kind"] == STOP) & (applied["value"] != 0.0)]
        found = {"applied": len(applied)}
        end = stage.ensemble.frame - round((NOTE_S + 2.0 * AHEAD_S) * RATE)
        for who, asked in stage.asked.items():
            frames = {key: begun["frame"][begun["value"] == key] for key, _ in asked}
            wanted = [(key, frame) for key, frame in asked if frame < end]
            # Keys of MIDI come again, later.
            came = [frames[key][frames[key] >= frame][:1] - frame for key, frame in wanted]
            found[f"{who} late"] = max(int(each[0]) for each in came if len(each))
            gone = [frame for (_, frame), each in zip(wanted, came, strict=True) if not len(each)]
            ended = sum(_is_ended(frame, block, panics) for frame in gone)
            found[f"{who} ended"], found[f"{who} lost"] = ended, len(gone) - ended
        dropped = stage.instrument._rig["mail"]["dropped"][0, :, 0]  # noqa: SLF001
        for who, writer in {"MIDI": MIDI_INPUTS, "OSC": SERVER, "pages": PAGES}.items():
            found[f"{who} dropped"] = int(dropped[writer])
        row = {name: max(number, row.get(name, 0)) for name, number in found.items()}
    times = np.min([times for _, times, _ in played], axis=0) * RATE / block
    return row | {"mean": float(times.mean()), "longest": float(times.max())}


def _is_ended(frame: int, block: int, panics: np.ndarray) -> bool:
    """Whether a panic of somebody ended a note for this frame, while it waited."""
    posted = frame - round(AHEAD_S * RATE) - block  # at the earliest
    return bool(((panics >= posted) & (panics <= frame + block)).any())


def failures(row: dict[str, Any], block: int) -> list[str]:
    """What misses its bound: a note is late by less than a block, MOST_OF_DEADLINE is taken."""
    doors = ("MIDI", *OSC_KEYS, "page")
    missed = [f"{who} late" for who in doors if row[f"{who} late"] >= block]
    missed += [f"{who} lost" for who in doors if row[f"{who} lost"]]
    return missed + ["longest"] * (row["longest"] > MOST_OF_DEADLINE)
