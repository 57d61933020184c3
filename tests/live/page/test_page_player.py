"""The page's player posts what the server's does: the same interpreter, in WebAssembly."""

import json
import math
import random
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from interpreted import Leader
from live.page import streams

from yehu_server.core.midi.events import FINGER_ON
from yehu_server.core.midi.tables import TABLES
from yehu_server.core.player.commands import BEGIN
from yehu_server.core.player.note_range import NoteRange
from yehu_server.live.page import facts
from yehu_server.params.table import find
from yehu_server.playing.mapping import Mapping, load, shipped_mappings
from yehu_server.playing.mapping_writer import as_toml
from yehu_server.playing.part_state import UNMAPPED, Key
from yehu_server.playing.player import Player
from yehu_server.playing.preset_folders import Presets
from yehu_server.playing.tables import Controls, make_tables
from yehu_server.playing.tuning import EQUAL, STANDARD_A4, Tuning, read_tuning

STREAMS, MANY_STREAMS = 50, 4_000
SOME_MAPPINGS = 12
HAND = -1  # channel of the only hand
# Those of named controls, which nothing moves on a page, and of programs, which it ignores; points
# may lie elsewhere, where somebody has taught the mapping something in place of their bind.
UNUSED = {"same", "input_lo", "input_hi", "program_row", "first_point", "x", "y"}

Requested = tuple[float, ...]  # frame, kind, index, value, other


class Recorder(Leader):
    """Stands for an instrument, and records what is asked of it, as soon as it is posted."""

    frame = 0
    is_live = False

    def __init__(self) -> None:
        super().__init__()
        self.commands: list[Requested] = []
        self.posted = 0

    def post(self, kind, *, frame=None, index=0, value=0.0, other=0.0, **_) -> bool:
        self.posted += 1
        at = -self.posted if frame is None else frame  # what is for now has a frame of its own
        for command in self.interpret(at, kind, index, value, other):
            self.commands.append((-1 if frame is None else frame, *command))
        return True

    def meters(self) -> dict[str, float]:
        return {"drained": self.posted, "next_frame": math.inf}

    def target(self, address: str) -> float:
        return find(address).default


NAMES = {"endPortNotes": "end_port_notes", "endNotes": "end_notes", "write": "set"}


class Server(Player):
    """A live player with the methods of the page's; a frame of None is now."""

    def __init__(self, mappings: dict[str, Mapping], tunings: dict[str, Tuning], presets) -> None:
        recorder = Recorder()
        super().__init__([recorder], presets=presets)
        self.mapped(UNMAPPED)
        self._mappings, self._tunings = mappings, tunings
        self._key: Key | None = None
        self.remap(mappings[facts.DEFAULT], frame=None)

    def call(self, method: str, *values: Any) -> None:
        """Do what the page's player does by this method."""
        *given, frame = values
        if method == "midi":
            data, frame, port = values
            self.receive(data, frame=frame, port=port)
        elif method == "fingerOn":
            _hand, at, velocity = given
            self._key = Key(HAND, at)
            self.post(FINGER_ON, frame, HAND, at, velocity)
        elif method == "noteOff" and self._key is not None:
            self.key_off(self._key, frame=frame)
        elif method == "lift":
            self.lift(frame=frame)
        elif method == "applyPreset":
            self.load(self.presets.load(given[0]).values, frame=frame)
        elif method == "remap":
            self.remap(self._mappings[given[0]], frame=frame)
        elif method == "applyTuning":  # options of the server's do not change
            self._tuning = self._tunings[values[0]]
            in_use = self.record["tables"]
            self.instrument.tables[in_use] = self._tables()[0]
        else:
            name = NAMES.get(method, method)
            getattr(self, name)(*given, frame=frame)


@pytest.fixture(scope="module")
def taught(tmp_path_factory) -> dict[str, dict[str, Any]]:
    """Of each shipped mapping one that somebody has taught: as files have it and as pages do."""
    chance, folder = random.Random(4), tmp_path_factory.mktemp("taught")
    found = {}
    for base in shipped_mappings():
        contents = streams.some_learned(chance, base)
        file = folder / f"taught-{base}.toml"
        file.write_text(as_toml(contents))
        binds = [
            {"source": b.source, "target": b.target, "span": b.span, "isSoft": b.is_soft}
            for b in contents.binds
        ]
        found[file.stem] = {"mapping": load(str(file)), "page": {"base": base, "learned": binds}}
    return found


@pytest.fixture(scope="module")
def mappings(taught) -> dict[str, Mapping]:
    """Shipped ones, those that were taught, and any others."""
    chance = random.Random(1)
    made = [streams.some_mapping(chance, f"made {number}") for number in range(SOME_MAPPINGS)]
    shipped = {name: load(name) for name in shipped_mappings()}
    own = {name: each["mapping"] for name, each in taught.items()}
    return shipped | own | {mapping.name: mapping for mapping in made}


@pytest.fixture(scope="module")
def page_results(run_node, playing, mappings, taught, everything):
    """Streams of calls, the tables that the page makes, and the commands that each comes to."""
    made = streams.Streams(2, list(mappings))
    played = [made.next() for _ in range(MANY_STREAMS if everything else STREAMS)]
    own = {name: facts.mapping(mapping) for name, mapping in mappings.items()}
    own |= {name: each["page"] for name, each in taught.items()}
    tables, *commands = play(run_node, playing, own, *played)
    return played, tables, commands


def play(run_node, folder: Path, *lines: Any) -> list[Any]:
    """What the page of a folder answers to mappings and streams: see ``playing.mjs``."""
    return [*map(json.loads, run_node("playing.mjs", folder, lines=lines).splitlines())]


def test_the_page_commands_what_the_server_commands(page_results, mappings, tmp_path):
    presets, kinds = Presets(tmp_path), set()
    tunings = {
        name: EQUAL if name == "equal" else read_tuning(*map(Path, name.split(", ")))
        for name in streams.TUNINGS
    }
    played, _, commanded = page_results
    for number, (calls, page) in enumerate(zip(played, commanded, strict=True)):
        server = Server(mappings, tunings, presets)
        for call in calls:
            server.call(*call)
        wanted = np.array(server.instrument.commands)
        found = np.array(page).reshape(-1, 5)
        assert found.shape == wanted.shape, (number, calls)
        assert np.allclose(found, wanted, rtol=1e-12, atol=1e-12), (number, calls)
        kinds |= set(wanted[:, 1])
    assert len(kinds) == len(facts.facts()["kinds"]) - 2  # the page posts no ramps, and holds none


def test_the_page_writes_the_tables_that_the_server_writes(page_results, mappings):
    tuning = read_tuning(Path("chaozhou-seven-equal"))
    _, tables, _ = page_results
    for name, mapping in mappings.items():
        policy = Player([Recorder()]).policy
        wanted = make_tables(mapping, Controls(), tuning=tuning, a4=STANDARD_A4, policy=policy)
        found = np.array([math.nan if x is None else x for x in tables[name]]).view(TABLES)
        for field in set(TABLES.names or ()) - UNUSED:
            np.testing.assert_array_equal(found[field], wanted[field], f"{name}: {field}")
        assert points_of(found[0]) == points_of(wanted[0]), name


def points_of(table: Any) -> list[list[tuple[float, float]]]:
    """The points of each bind's curve."""
    points = list(zip(table["x"].tolist(), table["y"].tolist(), strict=True))
    firsts, counts = table["first_point"].astype(int), table["points"].astype(int)
    return [points[first : first + count] for first, count in zip(firsts, counts, strict=True)]


def test_the_page_of_another_fiddle_plays_that_fiddles_notes(run_node, playing, tmp_path):
    folder = tmp_path / "web"
    shutil.copytree(playing, folder)
    erhu = NoteRange((62, 69), (11.5, 24.0))
    (folder / "facts.js").write_text(facts.module(facts.facts(erhu)))
    calls = [["midi", [0x90, key, 90], number, 0] for number, key in enumerate((61, 62, 93, 94))]
    _, commands = play(run_node, folder, {}, calls)
    begun = [command[4] for command in np.reshape(commands, (-1, 5)) if command[1] == BEGIN]
    assert begun == [73.0, 62.0, 93.0, 82.0]  # an octave from what it has not


def test_the_page_s_own_player_has_hands(run_node, playing, everything):
    run_node("--test", "player.test.mjs", WEB=str(playing), EVERYTHING="yes" * everything)


def test_performances_in_links_and_files_are_bounded_and_reach_nothing_but_the_sound(
    run_node, page, everything
):
    many = "2000" if everything else "200"
    run_node("--test", "performances.test.mjs", WEB=str(page), MANY=many)


def test_the_service_worker_keeps_what_it_knows_and_needs_no_store(run_node, page):
    run_node("--test", "worker.test.mjs", WEB=str(page))
