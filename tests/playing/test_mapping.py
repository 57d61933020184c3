"""Mapping files: their entries, and the wording of errors."""

import mido
import pytest
from curves import from_unit

from yehu_server.errors import MappingError
from yehu_server.params.articulations import ARTICULATIONS
from yehu_server.params.spec import Curve
from yehu_server.playing.mapping import Bind, load, mapping_folder, shipped_mappings
from yehu_server.playing.mapping_file import read_mapping_file
from yehu_server.playing.mapping_writer import as_toml, canonical

SHIPPED = shipped_mappings()
BIND = '[[bind]]\nsource = "cc 4"\ntarget = "/playing/pressure"\n'


@pytest.fixture
def read(tmp_path):
    def from_text(text: str | bytes):
        path = tmp_path / "mine.toml"
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return load(str(path))

    return from_text


# ---------------------------------------------------------------- what ships


@pytest.mark.parametrize("name", SHIPPED)
def test_a_shipped_mapping_is_explained_and_audible_before_any_controller_moves(
    name, player, listener
):
    """Its file is in canonical form, and the middle of its pan is the middle of the stage."""
    path = mapping_folder() / f"{name}.toml"
    mapping, text, contents = load(name), path.read_text("utf-8"), read_mapping_file(path)
    assert mapping == load(str(path))
    assert mapping.name == name
    assert canonical(contents, text) == text
    assert read_mapping_file(path, as_toml(contents)) == contents
    assert f"`{name}`" in (mapping_folder() / "README.md").read_text("utf-8")
    (pan,) = mapping.of("cc 10")
    pans = [from_unit(pan, value / 127.0) for value in (0, 1, 64, 127)]
    assert pans == pytest.approx([-1.0, -1.0, 0.0, 1.0], abs=1e-12)
    midi = player.mapped(mapping)
    midi.receive(mido.Message("note_on", note=74, velocity=80, channel=1))
    assert abs(listener["/bow/speed"]) > 0.1
    assert listener["/output/level"] > 0.3


def test_the_keyboard_mapping_gives_each_controller_its_role():
    roles = {
        "bend": ["/playing/bend"],
        "pressure": ["/playing/press", "/playing/vibrato_press"],
        "poly-pressure": ["/playing/press", "/playing/vibrato_press"],
        "cc 1": ["/playing/intensity"],
        "cc 77": ["/playing/vibrato"],
        "velocity": ["/playing/velocity", "/playing/pressure"],
        "cc 7": ["/playing/volume"],
        "cc 10": ["/room/pan"],
        "cc 11": ["/playing/dynamics"],
        "cc 16": ["/playing/speed"],
    }
    binds = {source: load("keyboard").of(source) for source in roles}
    assert {source: [bind.target for bind in of] for source, of in binds.items()} == roles
    for bind in (bind for source, of in binds.items() if source != "bend" for bind in of):
        assert from_unit(bind, 0.0) < from_unit(bind, 0.5) < from_unit(bind, 1.0)


# ---------------------------------------------------------------- how far and along which curve


def test_a_span_is_spread_along_its_curve_over_the_way_of_the_controller():
    for span, curve, values in [
        ((0.3, 0.7), None, [0.3, 0.5, 0.7]),
        ((0.7, 0.3), None, [0.7, 0.5, 0.3]),
        ((0.1, 0.9), Curve.EXP, [0.1, 0.3, 0.9]),  # by equal ratios
        ((0.9, 0.1), Curve.EXP, [0.9, 0.3, 0.1]),
        ((0.1, 0.9), Curve.S, [0.1, 0.5, 0.9]),
    ]:
        bind = Bind("cc 4", "/playing/pressure", span, *([curve] if curve else []))
        assert [from_unit(bind, unit) for unit in (0.0, 0.5, 1.0)] == pytest.approx(values)
    bind = Bind("cc 4", "/playing/volume", None, Curve.S)  # gentle at both ends
    assert 0.0 < from_unit(bind, 0.01) < 0.001
    assert from_unit(bind, 0.3) + from_unit(bind, 0.7) == pytest.approx(1.0)


def test_a_mapping_without_a_name_has_its_files_which_needs_no_toml_ending(read, tmp_path):
    assert read(BIND).name == "mine"
    assert read('name = "yours"\n').name == "yours"
    path = tmp_path / "pedal"
    path.write_text(BIND)
    assert (len(load(str(path)).binds), load(str(path)).name) == (1, "pedal")


# ---------------------------------------------------------------- what is wrong


def test_what_is_no_mapping_says_so(read, tmp_path):
    for text, wrong in [
        (BIND + BIND.replace("[[bind]]", "[bind]"), "not a mapping file"),
        ("[bind]\nsource = 1", r"\[\[bind\]\]"),
        ("key_switches = 60\n", "whole number from 0 to"),  # they lie below the notes
        ('[start]\n"/bow/speed" = 0.1\n', "/bow/speed.*moved by"),
    ]:
        with pytest.raises(MappingError, match=rf"mine\.toml.*{wrong}") as caught:
            read(text)
        assert str(caught.value).isprintable()
    for path in (tmp_path / "none.toml", tmp_path):
        with pytest.raises(MappingError, match=path.name):
            load(str(path))
    with pytest.raises(MappingError, match=r"'keybord'.*keyboard"):
        load("keybord")


# ---------------------------------------------------------------- what else a file says


def test_key_switches_choose_articulations_and_sound_no_notes(player, listener):
    midi = player.mapped(load("keyboard-articulations"))
    chosen = []
    last = 36 + len(ARTICULATIONS) - 1
    for key in (36, last, 39):
        midi.receive(mido.Message("note_on", note=key, velocity=80))
        midi.receive(mido.Message("note_off", note=key))
        chosen.append(player.value("/playing/articulation"))
    assert chosen == [0.0, len(ARTICULATIONS) - 1.0, 3.0]
    assert listener.of("/bow/side") == []
    midi.receive(mido.Message("note_on", note=last + 1, velocity=80))  # the next key plays
    assert listener["/bow/side"] != 0.0
    midi.receive(mido.Message("control_change", control=32, value=5))
    assert player.value("/playing/articulation") == 5.0
