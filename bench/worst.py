"""The worst block: of hard playing, or beside random mixes of all that may be sent.

    .venv/bin/python bench/worst.py [--seconds 60] [--save bench/results/NAME.json]
    .venv/bin/python bench/worst.py --mixes 20 --seconds 2

Hard playing is everything that costs time: four fingers that trill, slide and press up to 6 N,
tremolo, wide vibrato, scratching and flautando, string crossings, plucks, strings being tuned. The
CPU time is that of this thread, which leaves out most of what else the machine does.

With --mixes, players by MIDI, by OSC and on a page play a note every 10 ms, the page half of them
50 ms ahead. Beside them plays a random mix: up to 31 pages, of owners and guests, that send all
kinds of commands as fast as they may, now and ahead; up to 20 others by OSC, with up to twice the
notes that are admitted, some in bundles for one time; another MIDI input. A note is late by the
frames from the one that it was sent for to the one at which it was applied. Time is that of frames,
and of RUNS the least CPU time of each block counts; sockets and the system's scheduling are left
out.
"""

from __future__ import annotations

import argparse
import itertools
import random
import time
from collections.abc import Iterator
from typing import Any

import numpy as np
import report

from yehu_server.core.engine.instrument import Instrument
from yehu_server.core.engine.mailbox import MIDI_INPUTS, PAGES, SENDER_QUEUES, SERVER
from yehu_server.core.engine.rig import ring_place
from yehu_server.core.engine.spec import InstrumentSpec
from yehu_server.core.midi.events import DISCONNECT, MESSAGE
from yehu_server.core.player.commands import BEGIN, DRAW, END, KINDS, SLIDE, WRITE
from yehu_server.live import limits
from yehu_server.live.audio.output import shared_memory
from yehu_server.live.midi.feed import MidiFeed, SharedRing
from yehu_server.live.midi.routes import Router
from yehu_server.live.page.guests import OWN, PLAY
from yehu_server.live.page.players import LOWEST, PagePlayers, permitted
from yehu_server.live.page.shared_view import SharedView
from yehu_server.live.page.sockets import AT_ONCE, NOW, SETTINGS
from yehu_server.params.table import ENGINE, TABLE
from yehu_server.playing.calibration_store import calibration_for
from yehu_server.playing.options import PlayingOptions
from yehu_server.playing.parts import assemble, player_of
from yehu_server.playing.player import SENDER
from yehu_server.util.token_bucket import TokenBucket

RATE, BLOCK = 44100.0, 64
EVERY = 12  # blocks between two changes
HARD = {
    "/bow/speed": (-0.6, 0.6),
    "/bow/side": (-1.0, 1.0),
    "/bow/pressure": (0.05, 6.0),
    "/bow/position": (0.05, 0.3),
    "/bow/tremolo": (0.0, 16.0),
    "/bow/noise": (0.0, 0.3),
    "/vibrato/depth": (0.0, 100.0),
    "/pluck/force": (-3.0, 3.0),
    "/string/inner/tuning": (-100.0, 40.0),
    "/string/outer/loss": (0.3, 4.0),
    **{f"/finger/{number}/position": (0.01, 0.25) for number in (1, 2, 3, 4)},
    **{f"/finger/{number}/press": (-2.0, 6.0) for number in (1, 2, 3, 4)},  # below 0: up
}

BLOCKS, RUNS = (64, 128), 2
NOTE_S, AHEAD_S = 0.01, 0.05
KEYS = 60  # the players' begin here; those of a mix are lower
MIDI_KEYS, OSC_KEY, PAGE_KEY, STEP = 60, 121.0, 200.0, 0.005  # keys that tell notes apart


def play(instrument: Instrument, blocks: int) -> np.ndarray:
    """Play blocks; return the CPU time of each (s)."""
    chance = random.Random(7)  # noqa: S311 - for music, not secrets
    out = np.zeros(BLOCK, np.float32)
    times = np.zeros(blocks)
    known = {param.address: param for param in ENGINE}
    for block in range(blocks):
        if block % EVERY == 0:
            for address in chance.sample(sorted(HARD), 4):
                lo, hi = HARD[address]
                value = known[address].clamped(chance.uniform(lo, hi))
                if address == "/bow/side":
                    value = 1.0 if value > 0.0 else -1.0
                instrument.write(address, value)
        start = time.thread_time_ns()
        instrument.process(out)
        times[block] = 1e-9 * (time.thread_time_ns() - start)
    return times


# ---------------------------------------------------------------- mixes


class Page:
    """A page that sends commands of all kinds as fast as it may."""

    def __init__(self, number: int, of: int, chance: random.Random) -> None:
        self.number, self._chance = number, chance
        self._role = chance.choice((OWN, PLAY))
        self._many = chance.choice((1, 20, 300, limits.PAGE_EVENTS))  # of a message
        self._ahead_s = chance.choice((None, 0.0, 0.05, 0.2, 0.5))
        self._weights = [chance.random() ** 3 for _ in KINDS[WRITE:]]
        self._waiting = np.empty((0, 5))
        at_once = max(AT_ONCE, limits.PAGE_EVENTS_AT_ONCE / of)
        self._bucket = TokenBucket(limits.PAGE_EVENTS_A_SECOND, at_once)

    def play(self, players: PagePlayers, frame: int) -> None:
        """Post what a page may at a frame, as ``live.page.sockets`` does."""
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


class Stage:
    """A part on a stage, with all who play it, in a time of frames."""

    def __init__(self, mix: int) -> None:
        chance = self._chance = random.Random(mix)  # noqa: S311
        memory, options = shared_memory(), PlayingOptions()
        tuned = calibration_for(RATE)
        self.ensemble, (own,) = assemble([options], RATE, [tuned], memory=memory.buffer)
        self.instrument = self.ensemble.first
        self._player = player_of(0, options, own, delay_ms=0.0)
        view = SharedView(memory.handle)
        vars(view)["frame_of"] = lambda _ns: self.ensemble.frame
        self._pages = PagePlayers(view, [0])
        ring = SharedRing(memory.buffer, ring_place(MIDI_INPUTS, 0))
        self._feed = MidiFeed([ring], Router([], 1), message=MESSAGE, disconnect=DISCONNECT)
        self._feed.open("keys"), self._feed.open("pads")
        memory.close()
        count = chance.choice((1, 6, 31)) if mix else 0
        self._mix = [Page(number + 1, count, chance) for number in range(count)]
        self._osc = chance.choice((500.0, 2000.0, 17600.0)) if mix else 0.0  # notes a second
        self._senders = chance.choice((1, 4, 20))  # by OSC
        self._bundle = chance.choice((1, 20, 200))
        self._pads = chance.choice((0, 100, 1000)) if mix else 0  # MIDI messages a second
        self.asked: dict[str, list[tuple[float, int]]] = {"MIDI": [], "OSC": [], "page": []}

    def send(self, frames: int) -> None:
        """Send all that comes in a block."""
        begin = self.ensemble.frame
        for page in self._mix:
            page.play(self._pages, begin)
        for _ in _due(self._pads, begin, frames):
            chance = self._chance
            kind = chance.choice((0x80, 0x90, 0xA0, 0xB0, 0xC0, 0xD0, 0xE0))
            data = [chance.randrange(KEYS), chance.randrange(128)][: 1 + (kind not in (0xC0, 0xD0))]
            self._feed.receive("pads", [kind + chance.randrange(4), *data], 0)
        for n in _due(self._osc / self._bundle, begin, frames):
            SENDER.set(min(2 + n % self._senders, SENDER_QUEUES))
            at = begin + self._chance.choice((0, round(0.2 * RATE)))
            for _ in range(self._bundle):
                key, velocity = self._chance.randrange(KEYS), self._chance.randrange(128)
                self._player.key_on(float(key), float(velocity), frame=at)
        for n in _due(1.0 / NOTE_S, begin, frames):
            self._play_note(n, begin)

    def _play_note(self, n: int, frame: int) -> None:
        """Play a note by MIDI, by OSC and on a page, and end those before them."""
        key = KEYS + n % MIDI_KEYS
        self.asked["MIDI"].append((key, frame))
        self._feed.receive("keys", [0x90, key, 90], 0)
        self._feed.receive("keys", [0x80, KEYS + (n - 1) % MIDI_KEYS, 0], 0)
        SENDER.set(1)
        of_osc, of_page = (round(key + n * STEP, 3) for key in (OSC_KEY, PAGE_KEY))
        self.asked["OSC"].append((of_osc, frame))
        self._player.key_on(of_osc, 90.0, frame=frame)
        self._player.key_off(of_osc - STEP, frame=frame)
        at = frame + (n % 2) * round(AHEAD_S * RATE)
        self.asked["page"].append((of_page, at))
        # The note before is yet to come, or this one is.
        rows = [(at, BEGIN, 1, of_page, 72.0), (at, END, 1, round(of_page - 2 * STEP, 3), 0.0)]
        self._pages.post(0, 0, np.array(rows), 0)


def _due(a_second: float, begin: int, frames: int) -> Iterator[int]:
    """Number what comes so often, of that which comes in some frames."""
    first, end = (-int(-frame * a_second // RATE) for frame in (begin, begin + frames))
    return iter(range(first, end))


def run(mix: int, block: int, seconds: float) -> tuple[Stage, np.ndarray, np.ndarray]:
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


def figures(mix: int, block: int, seconds: float) -> dict[str, Any]:
    """Play beside a mix RUNS times; return a row of the table."""
    runs = [run(mix, block, seconds) for _ in range(RUNS)]
    row: dict[str, Any] = {}
    for stage, _, applied in runs:
        begun = applied[applied["kind"] == BEGIN]
        found = {"applied": len(applied)}
        end = stage.ensemble.frame - round((NOTE_S + 2.0 * AHEAD_S) * RATE)
        for who, asked in stage.asked.items():
            frames = {key: begun["frame"][begun["value"] == key] for key, _ in asked}
            wanted = [(key, frame) for key, frame in asked if frame < end]
            # Keys of MIDI come again, later.
            came = [frames[key][frames[key] >= frame][:1] - frame for key, frame in wanted]
            found[f"{who} late"] = max(int(each[0]) for each in came if len(each))
            found[f"{who} lost"] = sum(not len(each) for each in came)
        dropped = stage.instrument._rig["mail"]["dropped"][0, :, 0]  # noqa: SLF001
        for who, writer in {"MIDI": MIDI_INPUTS, "OSC": SERVER, "pages": PAGES}.items():
            found[f"{who} dropped"] = int(dropped[writer])
        row = {name: max(number, row.get(name, 0)) for name, number in found.items()}
    times = np.min([times for _, times, _ in runs], axis=0) * RATE / block
    return row | {"mean": float(times.mean()), "longest": float(times.max())}


def measure_mixes(mixes: int, seconds: float) -> dict[str, dict[str, Any]]:
    rows = {}
    for block, mix in itertools.product(BLOCKS, range(mixes + 1)):
        rows[f"{block}, {mix or 'alone'}"] = figures(mix, block, seconds)
    return rows


# ---------------------------------------------------------------- the whole


def measure(arguments: argparse.Namespace) -> dict[str, dict[str, float]]:
    if arguments.mixes:
        return measure_mixes(arguments.mixes, arguments.seconds)
    instrument = Instrument(InstrumentSpec(RATE))
    play(instrument, 100)
    times = play(instrument, round(arguments.seconds * RATE / BLOCK)) / (BLOCK / RATE)
    print(
        f"of the deadline of {1e3 * BLOCK / RATE:.2f} ms; {instrument.lost_states} lost states, "
        f"{instrument.unconverged_solves} unconverged solves"
    )
    shares = {"mean": times.mean(), "worst": times.max()}
    shares |= {f"{100 * share:g} %": np.quantile(times, share) for share in (0.999, 0.9999)}
    return {name: {"share": float(share)} for name, share in shares.items()}


if __name__ == "__main__":
    report.run(__doc__, measure, seconds=(60.0, "of playing"), mixes=(0, "random mixes"))
