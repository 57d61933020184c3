"""``yehu-server mappings``: list, show, check, convert."""

import json
from dataclasses import replace

from yehu_server.playing.mapping import load, shipped_mappings


def test_the_presets_are_listed_with_what_each_is_for(mappings):
    code, out, _ = mappings("list")
    assert code == 0
    lines = dict(line.split(maxsplit=1) for line in out.splitlines())
    assert list(lines) == shipped_mappings()
    assert all(lines.values())
    assert json.loads(mappings("list", "--json")[1]) == lines


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
    assert mappings("check", path)[:2] == (0, f"{path}: valid, 1 binds\n")


# ---------------------------------------------------------------- files of ones own

WRONG = """\
name = 3
[[bind]]
source = "cc 1/34"
target = "/playing/volume"
smoothing = -1
"""


def test_all_that_is_wrong_with_files_is_reported_line_by_line(mappings, tmp_path):
    wrong, right = tmp_path / "wrong.toml", tmp_path / "right.toml"
    wrong.write_text(WRONG)
    right.write_text('base = "keyboard"\n')
    code, out, err = mappings("check", wrong, right, tmp_path / "none.toml")
    assert code == 2
    assert out == f"{right}: valid, {len(load('keyboard').binds)} binds\n"
    lines = err.splitlines()
    for line, place in zip(lines, (":1: name", ":3: bind 1", ":5: bind 1", ""), strict=True):
        assert line.startswith("yehu-server: ")
        assert place in line
    assert "none.toml" in lines[-1]


def test_all_terms_of_a_bind_are_shown(mappings, tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(
        '[[bind]]\nsource = "nrpn 2/44"\ntarget = "/playing/attack"\nspan = [200, 10]\n'
        "curve = [[0, 0], [1, 0.5]]\ninvert = true\nsmoothing = 50\nchannel = [3, 2]\nsoft = true\n"
        "global = true\nlearned = true\n"
        '[[bind]]\nsource = "/f"\ntarget = "/playing/volume"\ninput = [0, 127]\npart = 2\n'
    )
    table = mappings("show", path)[1]
    for part in ("nrpn 300", "10 ms", "table", "channel 2", "50 ms", "soft", "global", "/f"):
        assert part in table.replace("\n", " ")
    first, second = json.loads(mappings("show", path, "--json")[1])["bind"]
    assert first == {
        "source": "nrpn 300",
        "target": "/playing/attack",
        "from": 200.0,
        "to": 10.0,
        "span": [200.0, 10.0],
        "curve": [[0.0, 0.0], [1.0, 0.5]],
        "invert": True,
        "smoothing": 50.0,
        "channel": [2, 3],
        "part": None,
        "soft": True,
        "alone": False,
        "global": True,
        "learned": True,
        "input": None,
        "replaces": None,
    }
    assert (second["input"], second["part"]) == ([0.0, 127.0], 2)


def test_a_preset_converted_or_shown_as_json_is_the_same_again(subtests, mappings, tmp_path):
    target, shown = tmp_path / "mine.toml", tmp_path / "shown"
    for name in shipped_mappings():
        with subtests.test(name):
            assert mappings("convert", name, "-o", target, "--overwrite")[0] == 0
            assert load(str(target)) == replace(load(name), name="mine")
            printed = tmp_path / f"{name}.toml"
            printed.write_text(mappings("convert", name)[1], encoding="utf-8")
            assert load(str(printed)) == load(name)
            shown.write_text(mappings("show", name, "--json")[1])
            assert mappings("convert", shown, "-o", target, "--overwrite")[0] == 0
            assert load(str(target)) == load(name)


def test_what_cannot_be_converted_writes_nothing(refused, tmp_path):
    path, target = tmp_path / "shown", tmp_path / "out.toml"
    for text in ("{", '{"bind": 3}', '{"bind": [3]}', '{"bind": [{}]}', '{"mpe": 1}', "[", "x"):
        path.write_text(text)
        assert str(path) in refused("mappings", "convert", path, "-o", target)
        assert not target.exists()


def test_a_file_may_be_converted_in_its_place(mappings, tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(
        '# mine\nbase = "wind"\n[[bind]]\nsource = "nrpn 2/44"\ntarget = "/playing/volume"\n'
    )
    before = path.read_text()
    code, _, err = mappings("convert", path, "-o", path)
    assert code == 2
    assert "mine.toml: exists; --overwrite" in err
    assert path.read_text() == before
    assert mappings("convert", path, "-o", path, "--overwrite")[0] == 0
    assert path.read_text().startswith('# mine\nname = "mine"\nbase = "wind"\n')
    assert load(str(path)).of("nrpn 300")
