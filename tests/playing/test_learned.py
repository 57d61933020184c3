"""Learned binds are kept in a file of the user, whole or not at all, with what they replace."""

import os
import tomllib
from pathlib import Path

import pytest
from curves import from_unit

from yehu_server.cli import main
from yehu_server.errors import MappingError, OutputError
from yehu_server.params.table import TABLE
from yehu_server.playing.learn import changes, learn, others, unlearn
from yehu_server.playing.learner import LearnedSource
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


def test_what_is_learned_for_a_shipped_mapping_is_there_at_the_next_start(settings):
    for name in shipped_mappings():
        mapping, path = learn(load(name), "/playing/vibrato_press", KNOB, soft=False)
        assert path == settings / "mappings" / f"{name}.toml"
        again = load(name, user_first=True)
        assert again == mapping == load(f"mine/{name}")
        assert moved_by(again, "cc 20") == ["/playing/vibrato_press"]
        (bind,) = again.of("cc 20")
        assert {*again.binds} == {bind, *load(name).binds}  # nothing else is taken away
        assert moved_by(load(name), "cc 20") == []  # rendering does not use it


def test_every_parameter_that_the_player_does_not_move_can_be_learned(everything):
    keyboard, free = load("keyboard"), [each for each in TABLE if not each.player_controlled]
    for param in free if everything else {each.curve: each for each in free}.values():
        mapping, _ = learn(keyboard, param.address, KNOB, soft=True)
        (bind,) = mapping.of("cc 20")
        assert bind.is_soft
        assert [from_unit(bind, 0.0), from_unit(bind, 1.0)] == pytest.approx([param.lo, param.hi])
        assert from_unit(bind, 0.3) == pytest.approx(param.from_unit(0.3)), param.curve
        assert load("mine/keyboard") == mapping, param.address


def test_a_control_is_added_and_moves_what_it_learned_last():
    target = "/playing/pressure"
    assert movers(load("keyboard"), target) == ["velocity"]
    mapping, _ = learn(load("keyboard"), target, KNOB, soft=False)
    mapping, _ = learn(mapping, target, LearnedSource("cc 1/33"), soft=False)
    assert movers(mapping, target) == ["velocity", "cc 20", "cc 1/33"]
    assert others(mapping, target, "cc 20") == ["velocity", "cc 1/33"]
    mapping, _ = learn(mapping, "/output/gain", LearnedSource("cc 1"), soft=False)
    assert moved_by(mapping, "cc 1") == ["/output/gain"]
    assert moved_by(mapping, "cc 1/33") == []
    mapping, _ = unlearn(mapping, "/output/gain")
    assert movers(mapping, target) == ["velocity", "cc 20", "cc 1/33"]
    mapping, count = unlearn(mapping, target)
    assert (count, mapping.binds) == (2, load("keyboard").binds)
    assert unlearn(mapping, target) == (mapping, 0)


def test_a_file_in_which_nothing_is_left_is_removed(settings):
    """Or each start would say that the user's own mapping plays, which is the shipped one."""
    file = settings / "mappings" / "keyboard.toml"
    mapping, _ = learn(load("keyboard"), "/playing/vibrato", KNOB, soft=False)
    mapping, _ = unlearn(mapping, "/playing/vibrato")
    assert not file.exists()
    assert mapping == load("keyboard")
    mapping, _ = learn(mapping, "/playing/vibrato", KNOB, soft=False)
    file.write_text("# My knobs.\n" + file.read_text())
    unlearn(mapping, "/playing/vibrato")
    assert file.read_text().startswith("# My knobs.")


def test_others_are_taken_away_only_if_asked_and_come_back():
    vibrato = load("keyboard-vibrato-wheel")
    before = movers(vibrato, "/playing/vibrato")
    assert len(before) > 1
    mapping, _ = learn(vibrato, "/playing/vibrato", LearnedSource("cc 21"), soft=False, only=True)
    assert movers(mapping, "/playing/vibrato") == ["cc 21"]
    mapping, _ = unlearn(mapping, "/playing/vibrato")
    assert movers(mapping, "/playing/vibrato") == before


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
        "source": "/x", "target": "/playing/tremolo", "input": [0, 127], "learned": True
    }  # fmt: skip
    unlearn(mapping, "/playing/vibrato")
    assert [bind["source"] for bind in tomllib.loads(file.read_text())["bind"]] == ["cc 4", "/x"]
    assert "# the left one" in file.read_text()


def test_a_file_that_was_broken_meanwhile_stays_and_is_reported(tmp_path):
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
    with pytest.raises(OutputError, match="no space left"):
        learn(load(str(file)), "/playing/vibrato", KNOB, soft=False)
    assert file.read_text() == 'name = "mine"\n'
    assert list(tmp_path.iterdir()) == [file]


def test_what_two_servers_learn_at_the_same_time_is_kept():
    targets = ("/playing/vibrato", "/playing/speed")
    process = os.fork()
    own = 0 if process == 0 else 1
    for number in range(10):
        knob = LearnedSource(f"cc {20 + 20 * own + number}")
        learn(load("keyboard", user_first=True), targets[own], knob, soft=False, only=True)
    if process == 0:
        os._exit(0)
    os.waitpid(process, 0)
    kept = load("mine/keyboard")
    assert [movers(kept, target) for target in targets] == [["cc 29"], ["cc 49"]]


# ---------------------------------------------------------------- what is given back

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


@pytest.fixture
def file(tmp_path) -> Path:
    path = tmp_path / "mine.toml"
    path.write_text(TEXT)
    return path


def taught(mapping: Mapping, target: str, source: str) -> Mapping:
    return learn(mapping, target, LearnedSource(source), soft=False, only=True)[0]


def binds(mapping: Mapping) -> set[tuple]:
    return {(bind.source, bind.target, bind.span) for bind in mapping.binds}


def test_what_learning_takes_is_reported_and_comes_back_also_after_a_new_start(file):
    before = load(str(file))
    mapping = taught(before, "/playing/vibrato", "cc 20")
    assert changes(before, mapping) == [("cc 5", "/playing/vibrato")]
    assert movers(mapping, "/playing/vibrato") == ["cc 20"]
    mapping, count = unlearn(load(str(file)), "/playing/vibrato")
    assert count == 1
    assert binds(mapping) == binds(before) == binds(load(str(file)))
    assert "replaces" not in file.read_text()
    mapping = taught(before, "/output/gain", "cc 5")
    both = [("cc 5", "/playing/vibrato"), ("cc 5", "/playing/vibrato_press")]
    assert changes(before, mapping) == both


VIBRATO, GAIN = "/playing/vibrato", "/output/gain"


@pytest.mark.parametrize("only", [False, True])
@pytest.mark.parametrize("alone", ["", "\nalone = true"])
def test_after_all_is_forgotten_all_is_as_it_was(subtests, file, alone, only):
    for name, lessons, forgotten in [
        ("all that the control did", [(GAIN, "cc 5")], [GAIN]),
        ("another control for the target", [(VIBRATO, "cc 20"), (VIBRATO, "cc 21")], [VIBRATO]),
        ("a control twice", [(VIBRATO, "cc 20"), (GAIN, "cc 20")], [GAIN, VIBRATO]),
        ("in the order learned", [(VIBRATO, "cc 20"), (GAIN, "cc 20")], [VIBRATO, GAIN]),
        ("two", [(VIBRATO, "cc 12"), (GAIN, "cc 5")], [VIBRATO, GAIN]),
        ("in any order", [(VIBRATO, "cc 12"), (GAIN, "cc 5")], [GAIN, VIBRATO]),
        ("what was taken already", [(GAIN, "cc 5"), (VIBRATO, "cc 21")], [GAIN, VIBRATO]),
    ]:
        with subtests.test(name):
            file.write_text(TEXT.replace("span = [0, 30]", f"span = [0, 30]{alone}"))
            before = mapping = load(str(file))
            for target, source in lessons:
                mapping, _ = learn(mapping, target, LearnedSource(source), soft=False, only=only)
            for target in forgotten:
                mapping, count = unlearn(mapping, target)
                assert count >= 1
            assert binds(mapping) == binds(before)


def test_a_learned_bind_comes_back_where_it_was_changed_by_hand(file):
    changed = ['curve = "s"', "span = [0, 30]", "invert = true", "smoothing = 50", "channel = 2"]
    for change in ["", *changed]:
        file.write_text(
            f'name = "mine"\n[[bind]]\nsource = "cc 20"\ntarget = "{VIBRATO}"\n'
            f"alone = true\nlearned = true\n{change}\n"
        )
        before = load(str(file))
        again, _ = unlearn(taught(before, VIBRATO, "cc 21"), VIBRATO)
        assert again.binds == (before.binds if change else ()), change


def test_what_is_wrong_in_what_is_kept_is_reported_with_its_place(file, capsys):
    kept = '[[bind]]\nsource = "cc 20"\ntarget = "/playing/vibrato"\n[[bind.replaces]]\n'
    file.write_text(f'name = "mine"\n{kept}source = "cc 500"\ntarget = "/output/gain"\n')
    assert main(["mappings", "check", str(file)]) == 2
    err = capsys.readouterr().err
    assert "mine.toml:6: bind 1: replaces 1: source" in err
    assert err.count("\n") == 1
