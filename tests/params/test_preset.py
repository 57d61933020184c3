"""Presets as text, and morphing between two."""

import re

import pytest

from yehu_server.errors import PresetError
from yehu_server.params.preset_file import (
    NOT_SAVED,
    POSSIBLE,
    SAVED,
    Preset,
    document_of,
    morph,
    preset_from,
)
from yehu_server.params.spec import Place
from yehu_server.params.table import TABLE

HEAD = "version = 1\n"


# ---------------------------------------------------------------- files


def parse(text, name):
    return preset_from(document_of(name, text), name)


def test_every_parameter_is_read_at_its_ends_and_its_default():
    for end in ("lo", "hi", "default"):
        values = {address: getattr(param, end) for address, param in POSSIBLE.items()}
        lines = "".join(f'"{address}" = {value!r}\n' for address, value in values.items())
        assert parse(f"{HEAD}[values]\n{lines}", "mine").values == values


def test_a_preset_may_have_all_the_players_and_nothing_that_the_player_moves():
    assert {p.address for p in TABLE if p.place is Place.PLAYER} <= set(POSSIBLE)
    assert not any(POSSIBLE[address].player_controlled for address in POSSIBLE)
    assert set(SAVED) == set(POSSIBLE) - NOT_SAVED
    assert set(POSSIBLE) >= NOT_SAVED


def test_an_unknown_address_is_left_out_with_a_remark_and_the_rest_is_read():
    preset = parse(HEAD + '[values]\n"/playing/sped" = 9\n"/playing/speed" = 0.2\n', "mine")
    assert preset.values == {"/playing/speed": 0.2}
    (remark,) = preset.remarks()
    assert "mine" in remark
    assert "'/playing/sped'" in remark
    assert "/playing/speed?" in remark


def test_of_very_many_unknown_addresses_some_are_named_and_the_rest_counted():
    lines = "".join(f'"/a/{number}" = 1\n' for number in range(1000))
    remarks = parse(f"{HEAD}[values]\n{lines}", "mine").remarks()
    assert len(remarks) == 11
    assert remarks[-1] == "mine: and 990 more"


def test_what_is_wrong_is_said_and_nothing_is_read(subtests):
    for text, reason in [
        ("", "no line version = 1"),
        ("version = true\n", "no line version = 1"),
        ("version = 2\nnew = 3\n", "2 is newer"),
        ("version = ", "not a preset file"),
        (HEAD + "nme = 3\n", "nme: unknown entry"),
        (HEAD + "about = 3\n", "about: expected a line"),
        (HEAD + "program = 0\n", "from 1 to 128, got 0"),
        (HEAD + "program = 129\n", "from 1 to 128, got 129"),
        (HEAD + "values = 3\n", "values: expected a table"),
        (HEAD + '[values]\n"/playing/speed" = 9\n', "/playing/speed: 9 is not within 0.03 to 0.6"),
        (HEAD + '[values]\n"/playing/speed" = "fast"\n', "/playing/speed: expected a number"),
        (HEAD + '[values]\n"/bow/speed" = 0.1\n', "/bow/speed: is moved by the player"),
        (HEAD + '[values]\n"/finger/1/press" = 1\n', "/finger/1/press: is moved by the player"),
    ]:
        with (
            subtests.test(text=text, reason=reason),
            pytest.raises(PresetError, match=re.escape(reason)),
        ):
            parse(text, "mine")


# ---------------------------------------------------------------- between two


def test_a_morph_begins_and_ends_at_the_very_values():
    one = Preset("one", {address: param.hi for address, param in POSSIBLE.items()})
    third = {address: param.from_unit(1.0 / 3.0) for address, param in POSSIBLE.items()}
    for amount, values in ((0.0, one.values), (-3.0, one.values), (1.0, third), (7.0, third)):
        assert morph(one, Preset("other", third), amount) == values
    choices = [address for address, param in POSSIBLE.items() if param.is_choice]
    for amount, values in ((0.49, one.values), (0.5, third)):
        found = morph(one, Preset("other", third), amount)
        assert [found[address] for address in choices] == [values[address] for address in choices]


def test_a_morph_never_leaves_the_range():
    for address, param in POSSIBLE.items():
        one, other = Preset("one", {address: param.lo}), Preset("other", {address: param.hi})
        for step in range(101):
            assert param.lo <= morph(one, other, step / 100)[address] <= param.hi
