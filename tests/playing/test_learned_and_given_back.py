"""Learning takes binds of the user's file away, keeps them, and gives them back."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from yehu_server.cli import main
from yehu_server.playing.learn import LearnedSource, changes, learn, unlearn
from yehu_server.playing.mapping import Mapping, load
from yehu_server.playing.mapping_file import read_mapping_file

TEXT = """name = "mine"

[[bind]]
source = "cc 5"           # the left pedal
target = "/playing/vibrato"
span = [0, 30]

[[bind]]
source = "cc 5"
target = "/playing/vibrato_press"

[[bind]]
source = "cc 12/44"
target = "/playing/pressure"
"""


@pytest.fixture(autouse=True)
def _own_settings(config_home):
    del config_home


@pytest.fixture
def file(tmp_path) -> Path:
    path = tmp_path / "mine.toml"
    path.write_text(TEXT)
    return path


def taught(mapping: Mapping, target: str, source: str) -> Mapping:
    return learn(mapping, target, LearnedSource(source), soft=False)[0]


def binds(mapping: Mapping) -> set[tuple]:
    return {(bind.source, bind.target, bind.span) for bind in mapping.binds}


def test_a_bind_of_the_same_target_comes_back(file):
    before = load(str(file))
    mapping = taught(before, "/playing/vibrato", "cc 20")
    assert changes(before, mapping) == [("cc 5", "/playing/vibrato")]
    assert [bind.source for bind in mapping.binds if bind.target == "/playing/vibrato"] == ["cc 20"]
    mapping, count = unlearn(load(str(file)), "/playing/vibrato")  # after a new start, too
    assert count == 1
    assert binds(mapping) == binds(before) == binds(load(str(file)))
    assert "replaces" not in file.read_text()


def test_all_that_the_moved_control_did_comes_back(file):
    before = load(str(file))
    mapping = taught(before, "/output/gain", "cc 5")
    assert changes(before, mapping) == [
        ("cc 5", "/playing/vibrato"), ("cc 5", "/playing/vibrato_press")
    ]  # fmt: skip
    assert binds(unlearn(mapping, "/output/gain")[0]) == binds(before)


def test_another_control_learned_for_the_target_keeps_what_the_first_took(file):
    before = load(str(file))
    mapping = taught(taught(before, "/playing/vibrato", "cc 20"), "/playing/vibrato", "cc 21")
    mapping, count = unlearn(mapping, "/playing/vibrato")
    assert count == 1
    assert binds(mapping) == binds(before)


def test_a_knob_that_moved_something_learned_before_goes_back_to_it(file):
    before = load(str(file))
    first = taught(before, "/playing/vibrato", "cc 20")
    mapping = taught(first, "/output/gain", "cc 20")
    mapping, _ = unlearn(mapping, "/output/gain")
    assert binds(mapping) == binds(first)
    assert binds(unlearn(mapping, "/playing/vibrato")[0]) == binds(before)


def test_what_was_learned_since_then_stays(file):
    before = load(str(file))
    mapping = taught(before, "/output/gain", "cc 5")
    mapping = taught(mapping, "/playing/vibrato", "cc 21")
    mapping, _ = unlearn(mapping, "/output/gain")
    assert [bind.source for bind in mapping.binds if bind.target == "/playing/vibrato"] == ["cc 21"]
    assert [bind.target for bind in mapping.of("cc 5")] == ["/playing/vibrato_press"]
    assert binds(unlearn(mapping, "/playing/vibrato")[0]) == binds(before)


@pytest.mark.parametrize("order", [("vibrato", "gain"), ("gain", "vibrato")])
def test_the_order_of_forgetting_does_not_matter(file, order):
    before = load(str(file))
    mapping = taught(before, "/playing/vibrato", "cc 12")
    mapping = taught(mapping, "/output/gain", "cc 5")
    for name in order:
        address = {"vibrato": "/playing/vibrato", "gain": "/output/gain"}[name]
        mapping, _ = unlearn(mapping, address)
    assert binds(mapping) == binds(before)


def test_a_bind_alone_that_the_user_has_written_comes_back(file):
    file.write_text(TEXT.replace("span = [0, 30]", "span = [0, 30]\nalone = true"))
    before = load(str(file))
    mapping = taught(before, "/playing/vibrato", "cc 20")
    assert binds(unlearn(mapping, "/playing/vibrato")[0]) == binds(before)


def test_what_is_kept_survives_conversion_by_way_of_json(file, tmp_path, capsys):
    taught(load(str(file)), "/output/gain", "cc 5")
    assert main(["mappings", "show", str(file), "--json"]) == 0
    shown = capsys.readouterr().out
    assert len(json.loads(shown)["bind"][-1]["replaces"]) == 2
    (tmp_path / "shown.json").write_text(shown)
    assert main(["mappings", "convert", str(tmp_path / "shown.json")]) == 0
    (tmp_path / "again.toml").write_text(capsys.readouterr().out)
    assert read_mapping_file(tmp_path / "again.toml").binds == read_mapping_file(file).binds


def test_what_is_wrong_in_what_is_kept_is_told_with_its_place(file, capsys):
    kept = '[[bind]]\nsource = "cc 20"\ntarget = "/playing/vibrato"\n[[bind.replaces]]\n'
    file.write_text(f'name = "mine"\n{kept}source = "cc 500"\ntarget = "/output/gain"\n')
    assert main(["mappings", "check", str(file)]) == 2
    err = capsys.readouterr().err
    assert "mine.toml:6: bind 1: replaces 1: source" in err
    assert err.count("\n") == 1
