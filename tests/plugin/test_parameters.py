"""Parameters as hosts see them, and their numbers, which are for ever."""

import shutil
from pathlib import Path

import pytest

from yehu_server.ahead import interface
from yehu_server.ahead.header import header as header_of_functions
from yehu_server.params.articulations import ARTICULATIONS
from yehu_server.params.preset_file import FIRST_LIVE
from yehu_server.params.spec import Curve
from yehu_server.params.table import TABLE
from yehu_server.playing.preset_folders import Presets
from yehu_server.plugin import build as building
from yehu_server.plugin.carried import MAPPINGS, carried
from yehu_server.plugin.header import header
from yehu_server.plugin.parameters import LEFT_OUT, MIN_NUMBER, parameters
from yehu_server.plugin.targets import SYSTEMS
from yehu_server.util.files import shipped_folder

HERE = Path(__file__).parent
NUMBERS = dict(line.split() for line in (HERE / "numbers.txt").read_text().splitlines())
CHOICES = ("/preset", "/room", "/mapping", "/tuning", "/chance")


def test_numbers_and_order_of_choices_are_for_ever(shown):
    assert {address: str(each.number) for address, each in shown.items()} == NUMBERS, (
        "hosts keep automation by these numbers: add new ones to numbers.txt, and change none"
    )
    assert shown["/preset"].choices[:9] == (
        *("none", "ordinary", "vibrato", "flautando", "sul-tasto", "sul-ponticello", "tremolo"),
        *("pizzicato", "scratch"),
    )
    kept = ("custom", "dry", "study", "courtyard", "hall", "chamber")
    assert shown["/room"].choices[:6] == kept
    kept = ("keyboard", "keyboard-expressive", "mpe", "sustain-pedal-tremolo", "wind")
    assert shown["/mapping"].choices[:5] == kept
    assert shown["/tuning"].choices[:2] == ("equal", "chaozhou-seven-equal")
    assert {path.stem for path in shipped_folder("mappings").glob("*.toml")} == set(MAPPINGS)


def test_every_parameter_of_the_table_is_there_as_it_is(shown):
    assert set(shown) - set(CHOICES) == {param.address for param in TABLE} - LEFT_OUT
    first = Presets(user_first=False).find(FIRST_LIVE).values
    for index, param in enumerate(TABLE):
        assert param.curve in (Curve.LIN, Curve.EXP)
        if param.address in LEFT_OUT:
            continue
        each = shown[param.address]
        hi = len(ARTICULATIONS) - 1 if param.address == "/playing/articulation" else param.hi
        found = each.index, each.lo, each.hi, each.default
        assert found == (index, param.lo, hi, first.get(param.address, param.default))
        assert each.is_exponential == (param.curve is Curve.EXP)
        assert (each.steps > 0) == param.is_choice
        assert each.unit == ("" if param.unit == "1" else param.unit)


def test_what_has_few_values_is_a_list_of_their_names(shown):
    names = {each.address: each.choices for each in shown.values() if each.group == "Playing"}
    assert names["/playing/articulation"] == tuple(each.name for each in ARTICULATIONS)
    assert names["/playing/direction"] == ("up", "alternating", "down")
    assert names["/playing/string"] == ("either", "inner", "outer")
    assert names["/playing/pizzicato"] == names["/playing/portamento"] == ("off", "on")
    for each in shown.values():
        assert len(each.choices) == (each.steps + 1 if 0 < each.steps < 100 else 0), each.name


def test_it_begins_as_the_page_and_the_server(shown):
    preset = shown["/preset"]
    assert preset.choices[int(preset.default)] == FIRST_LIVE
    room = shown["/room"].choices[int(shown["/room"].default)]
    page = (HERE.parents[1] / "web" / "views" / "sounds.js").read_text(encoding="utf-8")
    assert f'AT_FIRST = isServed ? [] : ["{FIRST_LIVE}", "{room}"];' in page


def test_names_numbers_and_symbols_are_of_one_parameter_each(shown):
    for what in ("name", "number", "symbol"):
        assert len({getattr(each, what) for each in shown.values()}) == len(shown)
    assert all(MIN_NUMBER <= each.number < 2 * MIN_NUMBER for each in shown.values())
    assert shown["/playing/bow_position"].name == "Bow position"
    assert shown["/bow/position"].name == "Bow position by hand"
    assert shown["/finger/2/press"].name == "Finger 2 press by hand"


def test_the_header_has_each_parameter_and_preset(shown):
    text = header(list(shown.values()), carried())
    for each in shown.values():
        assert f"{{{each.number}u, {each.index}, {each.steps}, " in text
    assert "static const Values presets[]" in text
    assert text == header(parameters(carried()), carried())  # the same each time


@pytest.mark.parametrize("name", building.COMMON[1:])
def test_the_sources_compile_without_a_word(tmp_path, monkeypatch, name):
    if shutil.which("g++") is None or not SYSTEMS[0].is_here:
        pytest.skip("there is no g++ for this system")
    strict = ("-Wall", "-Wextra", "-Werror")
    monkeypatch.setattr(building, "FLAGS", (*building.FLAGS, *strict))
    building.write_header(tmp_path)
    functions = interface.functions([48000.0], [[0, 0]], "0" * 16)  # without an instrument
    text = header_of_functions(functions, version="0", sources="0" * 16, rates=[48000.0])
    (tmp_path / "yehu.h").write_text(text)
    building.compile_file(building.SOURCE / name, tmp_path / "made.o", SYSTEMS[0], tmp_path)
    assert (tmp_path / "made.o").stat().st_size > 0
