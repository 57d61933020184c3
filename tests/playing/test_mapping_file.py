"""Mapping files: the line of each error, bases, and edited files."""

from dataclasses import replace

import pytest

from yehu_server.errors import MappingError, ParameterError
from yehu_server.params.spec import Curve
from yehu_server.params.table import assignment
from yehu_server.playing.bind import Bind, Breakpoints
from yehu_server.playing.mapping import load, mapping_folder, user_mappings
from yehu_server.playing.mapping_file import read_mapping_file
from yehu_server.playing.mapping_writer import canonical
from yehu_server.util.documents import MAX_ERRORS

BIND = '[[bind]]\nsource = "cc 4"\ntarget = "/playing/pressure"\n'
FULL = """\
# Three pedals.
name = "mine"  # not yours

[start] # begins
"/playing/attack" = 25

[[bind]]   # the first
source = "cc 1/33"
target = "/playing/pressure"
span = [0.1,
        0.9]
curve = [
  [0, 0], # [[bind]]
  [0.5, 0.2],
  [1, 1],
]
invert = true

[[bind]]
source = "nrpn 2/44"
target = "/playing/volume"
smoothing = 50
channel = [2, 1]
soft = true
global = true

# A fader.
[[bind]]
source = "/fader1"
target = "/playing/volume"
input = [0, 127]
curve = "s"
"""


@pytest.fixture
def read(tmp_path):
    def from_text(text: str):
        path = tmp_path / "mine.toml"
        path.write_text(text, encoding="utf-8")
        return load(str(path))

    return from_text


@pytest.fixture
def own(config_home):
    """Write a mapping into the user's folder."""
    folder = config_home / "yehu-server" / "mappings"
    folder.mkdir(parents=True)

    def write(name: str, text: str):
        (folder / f"{name}.toml").write_text(text, encoding="utf-8")
        return folder / f"{name}.toml"

    return write


def test_a_file_says_all_that_a_bind_has(read):
    table = Breakpoints(((0.0, 0.0), (0.5, 0.2), (1.0, 1.0)))
    assert read(FULL).binds == (
        Bind("cc 1/33", "/playing/pressure", (0.1, 0.9), table, invert=True),
        Bind(
            "nrpn 300",
            "/playing/volume",
            smoothing_ms=50.0,
            channels=(1, 2),
            is_soft=True,
            is_global=True,
        ),
        Bind("/fader1", "/playing/volume", curve=Curve.S, input_range=(0.0, 127.0)),
    )


# ---------------------------------------------------------------- errors and their lines


def test_an_error_names_its_line(subtests, read):
    for old, new, error in [
        ('"mine"', '"a\\nb"', "2: name: expected a line of text"),
        ('name = "mine"', 'nome = "mine"', "2: nome: unknown entry; did you mean name?"),
        ('name = "mine"', "mpe = 1", "2: mpe: expected true or false, got 1"),
        ('name = "mine"', 'base = "keybord"', "2: base: no mapping 'keybord'"),
        ('name = "mine"', 'base = "../keyboard"', "2: base: no mapping '../keyboard'"),
        ('name = "mine"', 'base = ""', "2: base: no mapping ''"),
        ("attack", "attac", "5: start: /playing/attac: unknown parameter '/playing/attac'"),
        ("= 25", "= 2500", "5: start: /playing/attack: 2500 is not within 5 to 500 ms"),
        ('"cc 1/33"', '"cc 1/34"', "8: bind 1: source: cc 1/34: the fine half of cc 1 is 33"),
        (
            '"cc 1/33"',
            '"cc 32/64"',
            "8: bind 1: source: cc 32/64: only cc 0 to 31 have a fine half",
        ),
        ('"cc 1/33"', '"cc 6/38"', "8: bind 1: source: cc 6/38 has a meaning of its own"),
        ('"cc 1/33"', '"nrpn 16383"', "8: bind 1: source: unknown source 'nrpn 16383'"),
        ('"cc 1/33"', '"/yehu/note"', "8: bind 1: source: /yehu/note: addresses under /yehu"),
        ('"cc 1/33"', '"/a b"', "8: bind 1: source: '/a b' is not an OSC address"),
        ('"/playing/pressure"', '"/playing/presure"', "9: bind 1: target: unknown parameter"),
        ('"/playing/pressure"', '"/bow/force"', "9: bind 1: target: /bow/force is moved by"),
        ("0.9]", "9]", "10: bind 1: span: 9 is not within 0.05 to 2"),
        ("0.9]", "]", "10: bind 1: span: expected [from, to], got [0.1]"),
        ("0.9]", '"2"]', "10: bind 1: span: expected a number, got '2'"),
        ("invert = true", "speed = 1", "17: bind 1: speed: unknown entry (known: source, target"),
        ("[0.5, 0.2]", "[0.5, 1.2]", "12: bind 1: curve: 1.2 is not within 0 to 1"),
        ("[0.5, 0.2]", "[0, 0.2]", "12: bind 1: curve: each point has to lie beyond"),
        ("[0.5, 0.2]", "[0.5]", "12: bind 1: curve: expected points [from, to], got [0.5]"),
        ("[1, 1]", "[0.9, 1]", "12: bind 1: curve: the points have to begin at 0 and end at 1"),
        ('curve = "s"', "curve = []", "32: bind 3: curve: the points have to begin"),
        ('curve = "s"', "curve = 3", "32: bind 3: curve: 3 is not one of linear, exp, s"),
        ('curve = "s"', 'curve = "exp"', "32: bind 3: curve: an exp curve needs a span above zero"),
        ("smoothing = 50", "smoothing = -1", "22: bind 2: smoothing: -1 is not within"),
        ("[2, 1]", "[2, 0]", "23: bind 2: channel: expected a whole number from 1"),
        ("[2, 1]", "17", "23: bind 2: channel: expected a whole number from 1 to 16"),
        ("[2, 1]", "[]", "23: bind 2: channel: expected a channel or several"),
        ("soft = true", 'soft = "yes"', "24: bind 2: soft: expected true or false, got 'yes'"),
        ("nrpn 2/44", "velocity", "24: bind 2: soft: velocity cannot wait for the target"),
        ("nrpn 2/44", "note", "24: bind 2: soft: note cannot wait"),
        ("nrpn 2/44", "poly-pressure", "24: bind 2: soft: poly-pressure cannot wait"),
        ("nrpn 2/44", "note", "25: bind 2: global: note belongs to one note"),
        ("[0, 127]", "[1, 1]", "31: bind 3: input: expected two different numbers"),
        ("[0, 127]", "127", "31: bind 3: input: expected [from, to], got 127"),
        ("[0, 127]", "[0, 1]\nglobal = true", "32: bind 3: global: an OSC address always is"),
        ("/fader1", "cc 9", "31: bind 3: input: only OSC addresses have an input range"),
        ('curve = "s"', "channel = 1", "32: bind 3: channel: an OSC address has no channel"),
        ('source = "/fader1"\n', "", "28: bind 3: needs a source and a target"),
        ('"mine"', '"mine', "2: not a mapping file"),
    ]:
        with subtests.test(old=old, new=new, error=error):
            assert old in FULL
            with pytest.raises(MappingError) as caught:
                read(FULL.replace(old, new, 1))
            lines = caught.value.lines
            assert any(f"mine.toml:{error}" in line for line in lines)
            assert all(line.isprintable() for line in lines)


def test_all_errors_of_a_file_are_reported_in_the_order_of_its_lines_unless_there_are_very_many(
    read,
):
    wrong = FULL.replace("0.9]", "9]").replace("cc 1/33", "cc 1/34").replace("= 50", "= -1")
    with pytest.raises(MappingError) as caught:
        read(wrong.replace('name = "mine"', "mpe = 2"))
    lines = [line.partition("mine.toml:")[2] for line in caught.value.lines]
    assert [line.split(":")[0] for line in lines] == ["2", "8", "10", "22"]
    with pytest.raises(MappingError) as caught:
        read(BIND.replace("pressure", "presure") * 200)
    assert len(caught.value.lines) == MAX_ERRORS


# ---------------------------------------------------------------- bases


def test_a_file_begins_with_its_base_and_replaces_what_its_controllers_did(read):
    keyboard = load("keyboard")
    mapping = read('base = "keyboard"\n' + BIND.replace("cc 4", "cc 1"))
    assert mapping.name == "mine"
    assert [bind.target for bind in mapping.of("cc 1")] == ["/playing/pressure"]
    kept = tuple(bind for bind in keyboard.binds if bind.source != "cc 1")
    assert mapping.binds == (*kept, *mapping.of("cc 1"))
    assert mapping.start == keyboard.start


def test_a_base_may_have_a_base_and_the_shipped_comes_before_the_users(own, read):
    own("wind", 'base = "wind"\n' + BIND)
    own("pedal", 'base = "mine/wind"\nabout = "my pedal"\n')
    assert user_mappings() == ["pedal", "wind"]
    assert load("wind").of("cc 4") == ()
    assert load("wind", user_first=True) == load("mine/wind")
    assert len(load("mine/wind").of("cc 4")) == 1
    assert read('base = "wind"\n').of("cc 4") == ()
    assert [file.stem for file in read('base = "wind"\n').files] == ["mine", "wind"]
    mapping = read('base = "pedal"\n')
    assert mapping.binds == (*load(str(mapping_folder() / "wind.toml")).binds, *mapping.of("cc 4"))
    assert [file.stem for file in mapping.files] == ["mine", "pedal", "wind", "wind"]


def test_bases_that_go_round_or_are_wrong_are_refused_by_their_file(own, read):
    own("one", 'base = "two"\n')
    file = own("two", '\nbase = "three"\n')
    own("three", 'base = "one"\n')
    for name in ("one", "two", "three"):
        with pytest.raises(MappingError, match=r"\.toml:\d: base: the bases go round in a circle"):
            load(name)
    file.write_text('base = "two"\n')
    with pytest.raises(MappingError, match=r"two\.toml:1: base: no mapping 'two'"):
        load("one")
    with pytest.raises(MappingError, match=r"no mapping 'mine/keyboard' .*yours: mine/one"):
        load("mine/keyboard")
    own("below", BIND + "span = [0, 9]\n")
    with pytest.raises(MappingError, match=r"below\.toml:4: bind 1: span"):
        read('base = "below"\n')


# ---------------------------------------------------------------- written anew


def test_what_is_tidied_says_what_it_shall_whatever_the_text_said():
    path = mapping_folder() / "keyboard.toml"
    contents = read_mapping_file(path)
    for name, other in {
        "name": "other",
        "about": "another",
        "base": "wind",
        "start": (("/playing/volume", 0.5),),
        "binds": contents.binds[1:],
        "mpe": True,
    }.items():
        changed = replace(contents, **{name: other})
        written = canonical(changed, path.read_text(encoding="utf-8"))
        assert read_mapping_file(path, written) == changed, name


def test_an_articulation_is_set_by_its_chinese_name_too():
    for text in ("articulation=颤音", "/playing/articulation=trill", "articulation=20"):
        assert assignment(text) == ("/playing/articulation", 20.0)
    assert assignment("vibrato=30") == ("/playing/vibrato", 30.0)
    for wrong in ("articulation=tril", "articulation", "string=颤音", "/room/size=颤音"):
        with pytest.raises(ParameterError):
            assignment(wrong)
