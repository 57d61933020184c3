"""The layout that all surfaces share."""

from dataclasses import replace

import pytest

from yehu_server.live.osc.call_table import CALLS
from yehu_server.params.table import TABLE, find
from yehu_server.surfaces import layout


def test_every_parameter_is_in_one_group_of_its_first_word():
    grouped = [(group.name, param) for group in layout.groups() for param in group.params]
    assert sorted(param.address for _, param in grouped) == sorted(p.address for p in TABLE)
    assert all(param.address.startswith(f"/{name}/") for name, param in grouped)


def test_what_the_player_goes_by_comes_first():
    assert layout.groups()[0].name == "playing"


def test_a_new_word_of_the_table_makes_a_group_of_its_own():
    new = replace(find("/bow/speed"), address="/rosin/amount")
    *_, last = layout.groups((*TABLE, new))
    assert (last.name, last.params) == ("rosin", (new,))


def test_labels_within_a_group_differ_and_keep_the_address_words():
    for group in layout.groups():
        labels = [layout.label(param) for param in group.params]
        assert len(set(labels)) == len(labels)
    assert layout.label(find("/finger/1/press")) == "1 press"
    assert layout.label(find("/playing/bow_position")) == "bow position"


@pytest.mark.parametrize(
    ("address", "axes"),
    [
        ("/pitch", [layout.STRING_PITCH]),
        ("/press", [layout.STRING_PRESS]),
        ("/bow", [layout.BOW_SPEED, layout.BOW_FORCE]),
    ],
)
def test_a_pad_sends_what_its_call_takes(address, axes):
    (call,) = (call for call in CALLS if call.address == address)
    for axis, argument in zip(axes, call.arguments, strict=True):
        assert argument.lo <= axis.lo <= axis.start <= axis.hi <= argument.hi


def test_the_keys_are_the_instruments_notes_by_their_names():
    assert (layout.KEYS[0].name, layout.KEYS[-1].name) == ("F4", "F6")
    assert [key.note for key in layout.KEYS] == list(range(65, 90))
    assert [key.name for key in layout.KEYS if key.note == 69] == ["A4"]
    assert all(key.is_black == ("#" in key.name) for key in layout.KEYS)


def test_a_subscription_is_renewed_before_it_ends():
    assert 2 * layout.SUBSCRIBE_EVERY_S < layout.SUBSCRIBED_S
