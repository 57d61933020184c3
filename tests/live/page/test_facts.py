"""The facts that the page gets are those of the server."""

import json
import re
from pathlib import Path

import mido
import numpy as np
import pytest

from yehu_server.core.midi.record import MIDI
from yehu_server.core.midi.tables import MAX_BINDS, TABLES
from yehu_server.live.page import examples, facts
from yehu_server.params.table import TABLE
from yehu_server.playing.mapping import load, shipped_mappings
from yehu_server.playing.tuning import read_tuning
from yehu_server.scores.smf.reader import read_score

ROOT = Path(__file__).parents[3]
FOR_SEVERAL = {"mo_li_hua"}


@pytest.fixture(scope="module")
def known() -> dict:
    """The facts as the page reads them."""
    text = facts.module(facts.facts())
    body = text.removeprefix(facts.HEAD).removeprefix("export default ").rstrip().rstrip(";")
    return json.loads(re.sub(r",\n}$", "\n}", body))


def test_each_mapping_is_there_and_leaves_room_for_what_may_be_learned(known):
    assert list(known["mappings"]) == shipped_mappings()
    for name, settings in known["mappings"].items():
        mapping = load(name)
        bound = [(bind["source"], bind["target"]) for bind in settings["binds"]]
        assert bound == [(bind.source, bind.target) for bind in mapping.binds]
        assert tuple(settings["start"].items()) == mapping.start
        assert (settings["mpe"], settings["about"]) == (mapping.mpe, mapping.about)
        assert len(bound) + len(TABLE) <= MAX_BINDS
    assert known["defaultMapping"] in known["mappings"]


def test_the_layout_of_the_interpreter_is_that_of_its_records(known):
    layout = known["interpreter"]
    for dtype, fields in ((MIDI, layout["record"]), (TABLES, layout["tables"])):
        for name, (at, size) in fields.items():
            made = np.zeros(1, dtype)
            made[name] = 1
            words = made.view(np.int64) if dtype is MIDI else made.view(np.float64)
            assert np.flatnonzero(words).tolist() == list(range(at, at + size))
    assert layout["length"] * 8 == TABLES.itemsize
    assert layout["tablesAt"] * 8 >= MIDI.itemsize


def test_each_tuning_is_there_on_every_shipped_map_of_keys(known):
    assert known["tunings"]["equal"]["keys"] is None
    for name, settings in known["tunings"].items():
        if name != "equal":
            tuning = read_tuning(*map(Path, name.split(", ")))
            assert settings["keys"] == [tuning.pitch(key, 440.0) for key in range(128)]
    maps = {file.stem for file in (ROOT / "tunings").glob("*.kbm")}
    assert {name.partition(", ")[2] for name in known["tunings"]} == maps | {""}


def test_each_example_has_its_events():
    found = examples.examples()
    tunes = {file.stem for file in (ROOT / "examples" / "tunes").glob("*.jianpu")}
    assert set(found) == {file.stem for file in (ROOT / "examples").glob("*.mid")} | tunes
    for name, example in found.items():
        if name in FOR_SEVERAL | tunes:
            continue
        events = read_score(ROOT / "examples" / f"{name}.mid").events
        assert example["mapping"] in shipped_mappings()
        for (seconds, data), event in zip(example["events"], events, strict=True):
            assert seconds == pytest.approx(event.time_s, abs=1e-6)
            assert mido.Message.from_bytes(data) == event.message


def test_of_a_score_for_several_the_page_plays_the_first_and_mpe_keeps_the_channels_of_its_zone():
    score = examples.example(ROOT / "examples" / "mo_li_hua.mid")
    assert {data[0] & 15 for _, data in score["events"] if data[0] < 0xF0} == {0}
    assert len([data for _, data in score["events"] if data[0] >> 4 == 9 and data[2]]) > 20
    score = examples.example(ROOT / "examples" / "mpe_phrase.mid")
    assert len({data[0] & 15 for _, data in score["events"] if data[0] < 0xF0}) > 1
