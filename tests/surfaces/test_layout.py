"""The layout that all surfaces share."""

from dataclasses import replace

import pytest

from yehu_server.live.osc.all_calls import CALLS
from yehu_server.params.table import TABLE, find
from yehu_server.surfaces import common_layout


def test_every_parameter_is_in_one_group_of_its_first_word():
    grouped = [(group.name, param) for group in common_layout.groups() for param in group.params]
    assert sorted(param.address for _, param in grouped) == sorted(p.address for p in TABLE)
    assert all(param.address.startswith(f"/{name}/") for name, param in grouped)
    assert grouped[0][0] == "playing"  # what the player goes by comes first


def test_a_new_word_of_the_table_makes_a_group_of_its_own():
    new = replace(find("/bow/speed"), address="/rosin/amount")
    *_, last = common_layout.groups((*TABLE, new))
    assert (last.name, last.params) == ("rosin", (new,))


def test_labels_within_a_group_differ_and_keep_the_address_words():
    for group in common_layout.groups():
        labels = [common_layout.label(param) for param in group.params]
        assert len(set(labels)) == len(labels)
    assert common_layout.label(find("/finger/1/press")) == "1 press"
    assert common_layout.label(find("/playing/bow_position")) == "bow position"


@pytest.mark.parametrize("pad", common_layout.PADS, ids=lambda pad: pad.name)
def test_a_pad_sends_what_its_calls_take(pad):
    for address, numbers in pad.calls:
        (call,) = (call for call in CALLS if call.address == address)
        for number, argument in zip(numbers, call.arguments, strict=True):
            axis = pad.axes[number]
            assert argument.lo <= axis.lo <= axis.start <= axis.hi <= argument.hi
