"""What a person teaches the page: it moves, is kept, and is a mapping file of the server's."""

from typing import Any

import pytest
from live.page.bound import placeless, rows_of
from live.page.browser import drive

from yehu_server.params.table import TABLE
from yehu_server.playing.mapping import load

INDEX = {param.address: index for index, param in enumerate(TABLE)}
VIBRATO, BOW_POSITION = INDEX["/playing/vibrato"], INDEX["/playing/bow_position"]


@pytest.fixture(scope="module")
def found(imitated) -> Any:
    """What followed as the page was taught."""
    return drive("page_learning.mjs", imitated)


def test_a_knob_that_moves_is_bound_over_the_whole_range_and_one_that_trembles_is_not(found):
    assert found["waiting"] == "Vibrato: now move a control"
    assert found["trembled"] == []
    assert found["learned"]["list"] == ["CC 74 Vibrato"]
    word = "Vibrato: CC 74 moves it; also CC 77, as before; no longer Bow position"
    assert found["learned"]["word"] == word
    param = TABLE[VIBRATO]
    ((row, value),) = found["learned"]["written"]
    assert (row, value) == (VIBRATO, pytest.approx(param.curve.from_unit(30 / 127, 0.0, param.hi)))
    assert found["followed"] == [[VIBRATO, param.hi]]


def test_a_button_beside_each_parameter_teaches_too_by_all_kinds_of_controls(found) -> None:
    assert found["asked"] == {"text": "now move a control", "pressed": "true"}
    assert found["text"] == "Aftertouch moves it"
    assert found["knobs"] == 0  # what the player moves itself cannot be taught
    assert found["all"] == [
        "CC 74 Vibrato",
        "Aftertouch Body to bridge",
        "Pitch bend Bend",
        "Aftertouch of a key Attack",
        "CC 20 Gain",
    ]
    assert found["stopped"] == found["all"]  # whoever stops waiting has taught nothing


def test_the_file_is_a_mapping_of_the_server_s(found, tmp_path) -> None:
    """Python's reader makes of it the very mapping that the page plays by."""
    assert found["file"]["name"] == "my-keyboard.toml"
    path = tmp_path / found["file"]["name"]
    path.write_text(found["file"]["text"])
    mapping = load(str(path))
    assert [*map(placeless, found["merged"])] == rows_of(mapping)
    (bind,) = mapping.of("cc 74")
    assert (bind.target, bind.span) == ("/playing/vibrato", (40.0, 5.0))
    assert [bind.is_soft for bind in mapping.of("pressure") + mapping.of("bend")] == [True, False]


def test_what_was_taught_belongs_to_its_mapping_and_is_remembered_until_it_is_forgotten(found):
    assert found["ofWind"] == []
    assert found["reloaded"] == found["all"]
    assert found["again"] == [[VIBRATO, 5]]
    assert found["afterTune"] == [[VIBRATO, 40]]
    assert found["forgotten"] == found["all"][1:]
    assert found["focusAfter"] == "Forget: Aftertouch, Body to bridge"
    assert [row for row, _ in found["backToMapping"]] == [BOW_POSITION]
