"""Mapping files: their entries, and the wording of errors."""

from __future__ import annotations

from pathlib import Path

import mido
import pytest
from curves import from_unit

from yehu_server.errors import MappingError
from yehu_server.params.articulations import ARTICULATIONS
from yehu_server.params.spec import Curve
from yehu_server.playing.mapping import Bind, load, mapping_folder
from yehu_server.playing.midi_poster import MidiPoster

ROOT = Path(__file__).resolve().parents[2]
BIND = '[[bind]]\nsource = "cc 4"\ntarget = "/playing/pressure"\n'


@pytest.fixture
def read(tmp_path):
    def from_text(text: str | bytes):
        path = tmp_path / "mine.toml"
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return load(str(path))

    return from_text


# ---------------------------------------------------------------- what ships


@pytest.mark.parametrize("path", sorted((ROOT / "mappings").glob("*.toml")), ids=lambda p: p.stem)
def test_every_shipped_mapping_loads_by_its_name(path):
    mapping = load(path.stem)
    assert mapping.name == path.stem
    assert mapping.binds
    assert mapping == load(str(path))


def test_the_keyboard_mapping_gives_each_controller_its_role(subtests):
    for source, targets in [
        ("bend", ["/playing/bend"]),
        ("pressure", ["/playing/press"]),
        ("poly-pressure", ["/playing/press"]),
        ("cc 1", ["/playing/vibrato", "/playing/vibrato_press"]),
        ("velocity", ["/playing/velocity", "/playing/pressure"]),
        ("cc 7", ["/playing/volume"]),
        ("cc 10", ["/room/pan"]),
        ("cc 11", ["/playing/dynamics"]),
        ("cc 16", ["/playing/speed"]),
    ]:
        with subtests.test(source=source, targets=targets):
            binds = load("keyboard").of(source)
            assert [bind.target for bind in binds] == targets
            for bind in binds:
                if source != "bend":
                    assert from_unit(bind, 0.0) < from_unit(bind, 0.5) < from_unit(bind, 1.0)


@pytest.mark.parametrize("path", sorted((ROOT / "mappings").glob("*.toml")), ids=lambda p: p.stem)
def test_the_middle_of_the_pan_is_the_middle_of_the_stage_with_each_mapping(path):
    (bind,) = load(path.stem).of("cc 10")
    pans = [from_unit(bind, value / 127.0) for value in (0, 1, 64, 127)]
    assert pans == pytest.approx([-1.0, -1.0, 0.0, 1.0], abs=1e-12)


# ---------------------------------------------------------------- how far and along which curve


def test_a_span_is_spread_over_the_whole_way_of_the_controller():
    bind = Bind("cc 4", "/playing/pressure", (0.3, 0.7))
    assert [from_unit(bind, unit) for unit in (0.0, 0.25, 1.0)] == pytest.approx([0.3, 0.4, 0.7])


def test_a_span_from_high_to_low_inverts():
    bind = Bind("cc 4", "/playing/pressure", (0.7, 0.3))
    assert [from_unit(bind, unit) for unit in (0.0, 0.25, 1.0)] == pytest.approx([0.7, 0.6, 0.3])


def test_an_exp_curve_goes_by_equal_ratios_either_way():
    up = Bind("cc 4", "/playing/pressure", (0.1, 0.9), Curve.EXP)
    assert [from_unit(up, unit) for unit in (0.0, 0.5, 1.0)] == pytest.approx([0.1, 0.3, 0.9])
    down = Bind("cc 4", "/playing/pressure", (0.9, 0.1), Curve.EXP)
    assert [from_unit(down, unit) for unit in (0.0, 0.5, 1.0)] == pytest.approx([0.9, 0.3, 0.1])


def test_an_s_curve_is_gentle_at_both_ends_and_even_about_the_middle():
    bind = Bind("cc 4", "/playing/volume", None, Curve.S)
    assert [from_unit(bind, unit) for unit in (0.0, 0.5, 1.0)] == pytest.approx([0.0, 0.5, 1.0])
    assert 0.0 < from_unit(bind, 0.01) < 0.001
    assert from_unit(bind, 0.3) + from_unit(bind, 0.7) == pytest.approx(1.0)


def test_without_a_span_the_way_is_the_targets_whole_range(read):
    (bind,) = read(BIND).binds
    assert (from_unit(bind, 0.0), from_unit(bind, 1.0)) == pytest.approx((0.05, 2.0))


def test_without_a_curve_the_targets_own_is_taken(read):
    (bind,) = read('[[bind]]\nsource = "cc 4"\ntarget = "/playing/speed"\n').binds
    assert from_unit(bind, 0.5) == pytest.approx((0.03 * 0.6) ** 0.5)


def test_one_source_may_move_several_targets(read):
    mapping = read(BIND + BIND.replace("pressure", "volume"))
    assert [bind.target for bind in mapping.of("cc 4")] == ["/playing/pressure", "/playing/volume"]
    assert mapping.of("cc 5") == ()


def test_a_mapping_without_a_name_has_its_files(read):
    assert read(BIND).name == "mine"
    assert read('name = "yours"\n').name == "yours"


def test_a_file_needs_no_toml_ending(tmp_path):
    path = tmp_path / "pedal"
    path.write_text(BIND)
    assert len(load(str(path)).binds) == 1


# ---------------------------------------------------------------- what is wrong


@pytest.mark.parametrize(
    ("text", "wrong"),
    [
        (BIND + BIND.replace("[[bind]]", "[bind]"), "not a mapping file"),
        ("names = 1", "names"),
        ("[bind]\nsource = 1", "[[bind]]"),
    ],
)
def test_a_file_that_is_no_mapping_says_so(read, text, wrong):
    with pytest.raises(MappingError, match=r"mine\.toml") as caught:
        read(text)
    assert wrong in str(caught.value)
    assert str(caught.value).isprintable()


def test_an_unknown_name_lists_what_ships():
    with pytest.raises(MappingError, match=r"'keybord'.*keyboard"):
        load("keybord")


def test_a_missing_file_and_a_folder_are_named(tmp_path):
    for path in (tmp_path / "none.toml", tmp_path):
        with pytest.raises(MappingError, match=path.name):
            load(str(path))


# ---------------------------------------------------------------- presets

SHIPPED = sorted(file.stem for file in mapping_folder().glob("*.toml"))


def test_the_presets_for_players_are_there():
    assert {"keyboard", "keyboard-expressive", "wind", "mpe", "sustain-pedal-tremolo"} <= set(
        SHIPPED
    )


@pytest.mark.parametrize("name", SHIPPED)
def test_a_preset_bears_its_own_name_and_is_explained(name):
    assert load(name).name == name
    assert f"`{name}`" in (mapping_folder() / "README.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("name", SHIPPED)
def test_a_preset_is_audible_before_any_controller_moves(name, player, listener):
    midi = MidiPoster(player, load(name))
    midi.receive(mido.Message("note_on", note=74, velocity=80, channel=1))
    assert abs(listener["/bow/speed"]) > 0.1
    assert listener["/output/level"] > 0.3


def test_a_mapping_says_where_parameters_begin(read, player):
    MidiPoster(player, read('[start]\n"/playing/dynamics" = 0.4\n'))
    assert player.value("/playing/dynamics") == 0.4


def test_what_is_held_begins_elsewhere(read, player):
    player.write("/playing/dynamics", 0.9, hold=True)
    MidiPoster(player, read('[start]\n"/playing/dynamics" = 0.4\n'))
    assert player.value("/playing/dynamics") == 0.9


def test_a_wrong_start_is_refused_with_a_reason(read):
    for address, reason in (("/playing/dynamic", "unknown parameter"), ("/bow/speed", "moved by")):
        with pytest.raises(MappingError, match=f"{address}.*{reason}"):
            read(f'[start]\n"{address}" = 0.1\n')


def test_a_mapping_may_give_the_sustain_pedal_another_meaning(read, player, listener):
    midi = MidiPoster(player, read('[[bind]]\nsource = "cc 64"\ntarget = "/playing/tremolo"\n'))
    midi.receive(mido.Message("note_on", note=74, velocity=80))
    midi.receive(mido.Message("control_change", control=64, value=127))
    assert listener["/bow/tremolo"] == 20.0
    midi.receive(mido.Message("note_off", note=74))
    assert player.sounding is None


def test_key_switches_choose_articulations_and_sound_no_notes(player, listener):
    midi = MidiPoster(player, load("keyboard-articulations"))
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


def test_without_key_switches_low_keys_play_and_a_bank_number_changes_nothing(player, listener):
    midi = MidiPoster(player, load("keyboard"))
    midi.receive(mido.Message("control_change", control=32, value=5))
    midi.receive(mido.Message("note_on", note=39, velocity=80))
    assert player.value("/playing/articulation") == 0.0
    assert listener["/bow/side"] != 0.0


def test_key_switches_lie_below_the_notes(read):
    with pytest.raises(MappingError, match="whole number from 0 to"):
        read("key_switches = 60\n")
