"""What the VST3 plug-in's controller reports, to a host in Python."""

import pytest
from plugin.vst3_host import Controller

from yehu_server.params.articulations import ARTICULATIONS

pytestmark = pytest.mark.slow
VALUES, KEYS = 1 << 2, 1 << 10  # flags of restartComponent
FIRST_KEY = 36


@pytest.fixture
def controller(built):
    return Controller(next((built / "Yehu.vst3").rglob("*.so")))


def test_what_a_preset_moves_is_to_be_read_again(controller, shown):
    preset, room, plucks, decay = (
        shown[name] for name in ("/preset", "/room", "/playing/pizzicato", "/room/decay")
    )
    choice = preset.choices.index("pizzicato") / preset.steps
    before = controller.get(decay.number)
    controller.set(preset.number, choice)
    assert controller.host.heard == [("restart", VALUES)]
    assert controller.get(plucks.number) == 1.0
    assert controller.get(decay.number) == before
    controller.set(preset.number, choice)  # again: nothing new
    assert controller.host.heard == [("restart", VALUES)]
    controller.set(decay.number, 0.5)  # of the room
    assert controller.host.heard == 2 * [("restart", VALUES)]
    assert controller.text(room.number, controller.get(room.number)) == "chamber, changed"
    assert controller.get(preset.number) == pytest.approx(choice)
    controller.set(plucks.number, 0.0)
    assert controller.host.heard == 3 * [("restart", VALUES)]
    assert controller.get(preset.number) == 0.0
    assert controller.text(preset.number, 0.0) == "pizzicato, changed"
    controller.set(plucks.number, 1.0)
    assert controller.get(preset.number) == pytest.approx(choice)


def test_keys_that_choose_articulations_are_key_switches_with_names(controller, shown):
    mapping = shown["/mapping"]
    assert controller.key_switches() == []
    assert controller.key_names() == {}
    choice = mapping.choices.index("keyboard-articulations") / mapping.steps
    controller.set(mapping.number, choice)
    assert ("names", 1, -1) in controller.host.heard
    assert controller.host.heard[-1][1] & KEYS
    names = [each.name for each in ARTICULATIONS]
    keys = range(FIRST_KEY, FIRST_KEY + len(names))
    assert controller.key_switches() == list(zip(names, keys, strict=True))
    assert controller.key_names() == dict(zip(keys, names, strict=True))
    assert controller.key_switches(channel=16) == []


def test_choices_are_shown_by_their_names(controller, shown):
    for each in shown.values():
        units = [step / each.steps for step in range(len(each.choices))]
        assert tuple(controller.text(each.number, unit) for unit in units) == each.choices


def test_numbers_that_are_none_do_no_harm(controller, shown):
    for each in shown.values():
        for unit in (float("nan"), float("inf"), -1e300, 1e300):
            controller.set(each.number, unit)
            assert 0.0 <= controller.get(each.number) <= 1.0
            assert controller.text(each.number, unit)
