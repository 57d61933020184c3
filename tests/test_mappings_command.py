"""``yehu-server mappings``: list, show, check."""

from __future__ import annotations

import json

import pytest

from yehu_server.playing.mapping import load, shipped_mappings


def test_the_presets_are_listed_with_what_each_is_for(mappings):
    code, out, _ = mappings("list")
    assert code == 0
    lines = dict(line.split(maxsplit=1) for line in out.splitlines())
    assert list(lines) == shipped_mappings()
    assert all(lines.values())
    assert json.loads(mappings("list", "--json")[1]) == lines


@pytest.mark.parametrize("name", shipped_mappings())
def test_a_preset_is_shown_with_all_that_it_moves(mappings, name):
    code, out, _ = mappings("show", name, "--json")
    assert code == 0
    shown, mapping = json.loads(out), load(name)
    assert (shown["name"], shown["mpe"]) == (name, mapping.mpe)
    assert shown["start"] == dict(mapping.start)
    assert [(bind["source"], bind["target"]) for bind in shown["bind"]] == [
        (bind.source, bind.target) for bind in mapping.binds
    ]
    table = mappings("show", name)[1]
    for bind in mapping.binds:
        assert bind.source in table


def test_a_file_of_ones_own_is_shown_and_checked(mappings, tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(
        'about = "[my] pedals"\n[start]\n"/playing/attack" = 25\n'
        '[[bind]]\nsource = "cc 4"\ntarget = "/playing/attack"\nspan = [200, 10]\n',
        encoding="utf-8",
    )
    code, out, _ = mappings("show", path)
    assert code == 0
    assert "mine: [my] pedals" in out
    for part in ("cc 4", "200 ms", "10 ms", "/playing/attack = 25 ms"):
        assert part in out
    assert mappings("check", path)[:2] == (0, f"{path}: right, 1 binds\n")


def test_the_bend_is_shown_as_its_range_says(mappings):
    bend = json.loads(mappings("show", "keyboard", "--json")[1])["bind"][0]
    assert (bend["source"], bend["from"], bend["to"]) == ("bend", None, None)
    assert "bend range" in mappings("show", "keyboard")[1]


def test_a_name_that_is_no_preset_lists_them(mappings):
    code, _, err = mappings("show", "winds")
    assert code == 2
    assert "wind" in err
    code, _, err = mappings("check", "wind")  # a file of that name, which there is not
    assert code == 2
