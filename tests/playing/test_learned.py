"""Learned binds are kept in a file of the user, whole or not at all."""

from __future__ import annotations

import os
import tomllib
from dataclasses import replace
from pathlib import Path

import pytest
from curves import from_unit

from yehu_server.errors import MappingError, OutputError, ParameterError
from yehu_server.params.table import TABLE
from yehu_server.playing.learn import LearnedSource, learn, unlearn
from yehu_server.playing.mapping import Mapping, load, shipped_mappings

KNOB = LearnedSource("cc 20")


@pytest.fixture(autouse=True)
def settings(config_home) -> Path:
    """Nothing is learned yet."""
    return config_home / "yehu-server"


def moved_by(mapping: Mapping, source: str) -> list[str]:
    return [bind.target for bind in mapping.of(source)]


def movers(mapping: Mapping, target: str) -> list[str]:
    return [bind.source for bind in mapping.binds if bind.target == target]


@pytest.mark.parametrize("name", shipped_mappings())
def test_what_is_learned_for_a_shipped_mapping_is_there_at_the_next_start(settings, name):
    mapping, path = learn(load(name), "/playing/vibrato_press", KNOB, soft=False)
    assert path == settings / "mappings" / f"{name}.toml"
    again = load(name, user_first=True)
    assert again == mapping
    assert moved_by(again, "cc 20") == ["/playing/vibrato_press"]
    assert set(again.binds) - {again.of("cc 20")[0]} <= set(load(name).binds)
    assert moved_by(load(name), "cc 20") == []  # rendering does not use it
    assert load(f"mine/{name}") == mapping


def test_every_parameter_that_the_player_does_not_move_can_be_learned(everything):
    keyboard, free = load("keyboard"), [each for each in TABLE if not each.owned]
    for param in free if everything else {each.curve: each for each in free}.values():
        mapping, _ = learn(keyboard, param.address, KNOB, soft=True)
        (bind,) = mapping.of("cc 20")
        assert bind.is_soft
        assert [from_unit(bind, 0.0), from_unit(bind, 1.0)] == pytest.approx([param.lo, param.hi])
        assert load("mine/keyboard") == mapping, param.address


@pytest.mark.parametrize(
    ("source", "is_global"),
    [("cc 20", True), ("bend", True), ("pressure", True), ("poly-pressure", False), ("/x", False)],
)
def test_what_is_learned_moves_the_notes_of_every_box(source, is_global):
    mapping, _ = learn(load("keyboard"), "/playing/vibrato", LearnedSource(source), soft=False)
    (bind,) = mapping.of(source)
    assert bind.is_global is is_global
    assert load("mine/keyboard") == mapping


def test_what_the_player_moves_cannot_be_learned(settings):
    with pytest.raises(ParameterError, match="/bow/speed is moved by the player"):
        learn(load("keyboard"), "/bow/speed", KNOB, soft=False)
    assert not settings.exists()


def test_nothing_else_moves_what_was_learned():
    assert movers(load("keyboard"), "/playing/pressure") == ["velocity"]
    mapping, _ = learn(load("keyboard"), "/playing/pressure", KNOB, soft=False)
    assert movers(mapping, "/playing/pressure") == ["cc 20"]
    mapping, _ = learn(mapping, "/playing/pressure", LearnedSource("cc 21"), soft=False)
    assert movers(mapping, "/playing/pressure") == ["cc 21"]
    mapping, count = unlearn(mapping, "/playing/pressure")
    assert count == 1
    assert movers(mapping, "/playing/pressure") == ["velocity"]
    assert unlearn(mapping, "/playing/pressure") == (mapping, 0)


def test_a_knob_moves_what_it_learned_last():
    mapping, _ = learn(load("keyboard"), "/playing/vibrato", LearnedSource("cc 1/33"), soft=False)
    mapping, _ = learn(mapping, "/output/gain", LearnedSource("cc 1"), soft=False)
    assert moved_by(mapping, "cc 1") == ["/output/gain"]
    assert moved_by(mapping, "cc 1/33") == []


def test_zones_that_the_command_line_asked_for_stay():
    mapping, _ = learn(replace(load("keyboard"), mpe=True), "/playing/vibrato", KNOB, soft=False)
    assert mapping.mpe
    assert unlearn(mapping, "/playing/vibrato")[0].mpe


def test_a_file_of_ones_own_keeps_its_comments_and_order(tmp_path):
    file = tmp_path / "mine.toml"
    text = """# My pedals.
name = "mine"

[[bind]]
source = "cc 4"           # the left one
target = "/playing/pressure"

[[bind]]
source = "cc 5"
target = "/playing/vibrato"
"""
    file.write_text(text)
    mapping, path = learn(
        load(str(file)), "/playing/tremolo", LearnedSource("/x", (0.0, 127.0)), soft=False
    )
    assert path == file
    assert file.read_text().startswith(text)
    assert tomllib.loads(file.read_text())["bind"][2] == {
        "source": "/x", "target": "/playing/tremolo", "input": [0, 127], "alone": True
    }  # fmt: skip
    unlearn(mapping, "/playing/vibrato")
    assert [bind["source"] for bind in tomllib.loads(file.read_text())["bind"]] == ["cc 4", "/x"]
    assert "# the left one" in file.read_text()


def test_a_file_that_was_broken_meanwhile_stays_and_is_told_of(tmp_path):
    file = tmp_path / "mine.toml"
    file.write_text('name = "mine"\n')
    mapping = load(str(file))
    file.write_text("not at all [")
    with pytest.raises(MappingError, match=r"mine\.toml:1"):
        learn(mapping, "/playing/vibrato", KNOB, soft=False)
    assert file.read_text() == "not at all ["


def test_a_crash_while_it_is_written_leaves_the_file_as_it_was(tmp_path, monkeypatch):
    file = tmp_path / "mine.toml"
    file.write_text('name = "mine"\n')

    def crash(_descriptor: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", crash)
    with pytest.raises(OutputError, match="No space left"):
        learn(load(str(file)), "/playing/vibrato", KNOB, soft=False)
    assert file.read_text() == 'name = "mine"\n'
    assert list(tmp_path.iterdir()) == [file]


def test_a_mapping_that_comes_from_no_file_cannot_learn():
    with pytest.raises(MappingError, match="comes from no file"):
        learn(Mapping("bare", ()), "/playing/vibrato", KNOB, soft=False)
