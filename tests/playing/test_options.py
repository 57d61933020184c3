"""The options of one player, from what is asked for to what is played."""

import pytest
from fiddles import SLACK_TOML

from yehu_lab.practising.practice_file import write_bowing_table
from yehu_server.core.player.bowing import default_bowing_table
from yehu_server.playing.options import PlayingOptions


@pytest.mark.parametrize(
    ("asked", "phrasing", "rubato"),
    [
        ({}, 0.5, 0.5),
        ({"phrasing": 0.0}, 0.0, 0.0),
        ({"rubato": 0.0}, 0.5, 0.0),
        ({"settings": (("/playing/phrasing", 0.3),)}, 0.3, 0.3),
        ({"settings": (("/playing/phrasing", 0.3),), "phrasing": 0.2, "rubato": 1.0}, 0.2, 1.0),
    ],
)
def test_what_is_asked_for_shapes_a_score_before_what_is_held_and_what_is_usual(
    asked, phrasing, rubato
):
    found = PlayingOptions(**asked).shaping(0.5)
    assert (found.phrasing, found.rubato) == (phrasing, rubato)


def test_an_instrument_comes_with_its_own_practice_and_not_with_anothers(tmp_path):
    mine, other = tmp_path / "mine.toml", tmp_path / "other.toml"
    for file in (mine, other):
        file.write_text(SLACK_TOML)
    practice = tmp_path / "mine.practice.json"
    write_bowing_table(practice, default_bowing_table(), 44100.0)
    usual = PlayingOptions()
    on_mine = usual.on_instrument(mine)
    assert (on_mine.instrument, on_mine.practice) == (mine, practice)
    assert on_mine.quantities != usual.quantities
    assert set(on_mine.files) >= {mine, practice}
    assert on_mine.on_instrument(None) == on_mine
    on_other = on_mine.on_instrument(other)
    assert (on_other.practice, on_other.bowing) == (None, None)
    assert on_other.on_instrument(other, practice).practice == practice
