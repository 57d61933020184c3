"""Presets of sounds and of rooms, alone and together."""

import pytest

from yehu_server.errors import PresetError
from yehu_server.playing.preset_folders import MAX_TOGETHER, Presets, is_name


@pytest.fixture
def presets(own_presets) -> Presets:
    return Presets(own_presets)


def test_a_bow_and_a_room_go_together_and_of_two_rooms_the_last_one_holds(presets):
    bow, room = presets.load("sul-tasto"), presets.load("hall")
    both = presets.find("sul-tasto+hall")
    assert both.name == "sul-tasto+hall"
    assert both.values == {**bow.values, **room.values}
    assert presets.find_file("sul-tasto+hall").stem == "sul-tasto"
    assert presets.load("hall+dry").values == presets.load("dry").values


def test_presets_of_the_players_own_go_together_with_others(presets):
    presets.own.mkdir(parents=True, exist_ok=True)
    file = presets.own / "cave.toml"
    file.write_text(
        'version = 1\n[values]\n"/room/decay" = 6\n"/room/dcay" = 1\n', encoding="utf-8"
    )
    try:
        both = presets.load("hall+mine/cave")
    finally:
        file.unlink()
    assert both.values["/room/decay"] == 6.0
    assert both.values["/room/size"] == 25.0
    assert both.unknown == ("/room/dcay",)


def test_a_name_that_is_none_is_reported_and_so_many_do_not_go_together(presets):
    for wrong in ("hall+", "+hall", "hall++dry", "hall+cellar", "hall+../x"):
        with pytest.raises(PresetError):
            presets.find(wrong)
    with pytest.raises(PresetError, match="at most 8 go together"):
        presets.load("+".join(["hall"] * (MAX_TOGETHER + 1)))
    assert is_name("sul-tasto+hall")
    assert not any(map(is_name, ("some+folder/preset.toml", "a+b.toml")))
