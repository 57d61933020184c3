"""TOML texts, bounded in the time they take."""

from __future__ import annotations

import pytest

from yehu_server.util.parsing import MOST_KEY_PARTS, parse_toml


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("a.b.c = 1", {"a": {"b": {"c": 1}}}),
        ("\"/a.b\".'c.d' = 1", {"/a.b": {"c.d": 1}}),
        (f'a = "{". " * 100}" # {"." * 100}', {"a": ". " * 100}),
        ("a = 1.5\nb = 1979-05-27T07:32:00.5", None),
    ],
)
def test_what_is_as_usual_is_read(text, value):
    found = parse_toml(text)
    assert value is None or found == value


@pytest.mark.parametrize("part", [".a", ' . "a b"', ".'a'", "\t.\ta-1"])
@pytest.mark.parametrize("around", ["{} = 1", "[{}]", "[[{}]]", "x = {{ {} = 1 }}"])
def test_a_key_of_very_many_parts_is_refused_before_it_takes_time(part, around):
    parse_toml(around.format("a" + part * (MOST_KEY_PARTS - 1)))
    with pytest.raises(ValueError, match="parts"):
        parse_toml(around.format("a" + part * 20_000))


@pytest.mark.parametrize("text", ["a" * 60_000, '"' * 60_000, "'a" * 30_000, "a.b " * 15_000])
def test_looking_for_such_keys_takes_no_time_itself(text):
    with pytest.raises(ValueError, match=r"at (line|end)"):
        parse_toml(text)
