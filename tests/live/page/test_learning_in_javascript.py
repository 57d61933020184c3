"""The page learns what the server learns from the same messages, and keeps it in the same file."""

import json
import random
from pathlib import Path
from typing import Any

import mido
import pytest
from live.page.bound import placeless, rows_of
from live.page.streams import FREE

from yehu_server.playing import learn
from yehu_server.playing.learner import Learner
from yehu_server.playing.mapping import Mapping, load, shipped_mappings
from yehu_server.playing.mapping_file import read_mapping_file

pytestmark = pytest.mark.slow

STREAMS = 600
CONTROLS = (1, 2, 6, 7, 11, 33, 34, 38, 39, 64, 74, 98, 99, 100, 101, 119, 121)


@pytest.fixture(autouse=True)
def settings(config_home) -> Path:
    """Nothing is learned yet."""
    return config_home


def message(chance: random.Random) -> list[Any]:
    """A port, and bytes that mean something to a learner, or that don't."""
    channel, value = chance.choice([0, 0, 3]), chance.choice([0, 5, 60, 64, 66, 90, 127])
    kind = chance.choice([0xB0, 0xB0, 0xB0, 0xB0, 0xE0, 0xD0, 0xA0, 0x90, 0xF8])
    data = {
        0xB0: [0xB0 | channel, chance.choice(CONTROLS), value],
        0xD0: [0xD0 | channel, value],
        0xF8: [0xF8],
    }.get(kind, [kind | channel, chance.randrange(128), value])
    return [chance.choice([0, 0, 1]), data]


def messages(chance: random.Random) -> list[list[Any]]:
    """Some messages; now and then controllers of 14 bits and non-registered parameters first."""
    some = [message(chance) for _ in range(chance.randint(1, 12))]
    coarse, number = chance.choice([1, 2, 7]), chance.choice([2, 44, 127])
    pair = [(coarse, 5), (coarse + 32, 9), (coarse, chance.choice([5, 60]))]
    nrpn = [(99, 127), (98, number), (6, 10), (38, 90), (6, 100)]
    first = chance.choice([pair, nrpn, [], []])
    return [*([0, [0xB0, *each]] for each in first), *some]


def stream(chance: random.Random) -> dict[str, Any]:
    targets = [param.address for param in chance.sample(FREE, 4)] + ["/playing/bend"]
    lessons: list[list[Any]] = []
    for _ in range(chance.randint(1, 8)):
        target = chance.choice(targets)
        forgets = chance.random() < 0.2
        lesson = (
            [] if forgets else [[chance.random() < 0.5, chance.random() < 0.3], messages(chance)]
        )
        lessons.append([target, *lesson])
    return {"name": chance.choice(shipped_mappings()), "lessons": lessons}


def expected(given: dict[str, Any], folder: Path) -> tuple[list[str | None], Mapping, Path]:
    """What the server finds and keeps."""
    mapping, sources = load(given["name"]), []
    for target, *rest in given["lessons"]:
        found = None
        if not rest:
            mapping, _ = learn.unlearn(mapping, target)
        else:
            learner = Learner()
            heard = (learner.hear(mido.Message.from_bytes(data), port) for port, data in rest[1])
            found = next((one for one in heard if one is not None), None)
        if found is not None:
            soft, only = rest[0]
            mapping, _ = learn.learn(mapping, target, found, soft=soft, only=only)
        sources.append(None if found is None else found.source)
    return sources, mapping, folder / "yehu-server" / "mappings" / f"{given['name']}.toml"


def test_the_page_learns_what_the_server_learns(run_node, page, settings):
    chance = random.Random(3)
    streams = [stream(chance) for _ in range(STREAMS)]
    answers = run_node("learning.mjs", page, lines=streams).splitlines()
    kinds: set[str] = set()
    for given, line in zip(streams, answers, strict=True):
        found = json.loads(line)
        sources, mapping, path = expected(given, settings)
        assert found["sources"] == sources, given
        assert [*map(placeless, found["binds"])] == rows_of(mapping), given
        own = Path(given["name"])
        contents = read_mapping_file(own, found["file"])
        if path.exists():
            kept = read_mapping_file(path)
            assert contents == kept
            path.unlink()
        else:
            assert contents.binds == ()
        kinds |= {source or "none" for source in sources}
    assert {"bend", "pressure", "poly-pressure", "cc 1", "none"} <= kinds
    assert any(kind.startswith("nrpn ") for kind in kinds), kinds
    assert any("/" in kind for kind in kinds), kinds
