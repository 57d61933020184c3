"""Surfaces for one part of a server with several."""

import re
from functools import cache

import pytest

from yehu_server.live.osc.all_calls import CALLS
from yehu_server.params.table import TABLE
from yehu_server.surfaces.catalogue import SURFACES, bytes_of

SERVER = ("127.0.0.1", 9000)
SPEAKING = [surface for surface in SURFACES if surface.name != "parameters.html"]
# An address of OSC, also as Pure Data writes it for `oscformat`.
ADDRESS = re.compile(r"(?<![\w.])/yehu(/[\w/-]+)")


@cache
def text_of(surface, part):
    return surface.content(bytes_of(surface, SERVER, part)).decode()


def addresses_of(surface, part):
    """The addresses in a surface, after the prefix."""
    return set(ADDRESS.findall(text_of(surface, part)))


@pytest.mark.parametrize("part", [1, 2, 16])
@pytest.mark.parametrize("surface", SURFACES, ids=lambda surface: surface.name)
def test_what_a_part_has_of_its_own_is_at_its_addresses_and_what_all_share_is_not(surface, part):
    found = addresses_of(surface, part)
    shared = {param.address for param in TABLE if param.is_shared}
    for param in TABLE:
        own, common = f"/part/{part}{param.address}", param.address
        at, elsewhere = (common, own) if param.address in shared else (own, common)
        forms = {at, f"{at}/unit"}
        assert forms & found, param.address
        assert not {elsewhere, f"{elsewhere}/unit"} & found, param.address
    if surface in SPEAKING:  # the page's texts name some
        assert not {"/note", "/release", "/panic"} & found


@pytest.mark.parametrize("surface", SPEAKING, ids=lambda surface: surface.name)
def test_it_subscribes_to_the_part_and_to_what_all_share(surface):
    text = text_of(surface, 3)
    asked = {at.removesuffix("/unit") for at in addresses_of(surface, 3) if "/subscribe" in at}
    if surface.name == "yehu.pd":
        assert "oscformat yehu part 3 subscribe;" in text
        assert "oscformat yehu subscribe;" in text
    else:
        assert asked == {"/part/3/subscribe", "/subscribe"}


def test_the_page_has_the_calls_that_no_part_has_at_their_own_addresses():
    (page,) = (surface for surface in SURFACES if surface not in SPEAKING)
    found = addresses_of(page, 2)
    for call in CALLS:
        assert (call.address if call.is_for_all else f"/part/2{call.address}") in found


@pytest.mark.parametrize("name", ["yehu.pd", "yehu.maxpat"])
def test_patches_of_two_parts_do_not_hear_each_other(name):
    (surface,) = (surface for surface in SURFACES if surface.name == name)
    names = [
        set(re.findall(r"\b(yehu(?:\.part\.\d)?\.[a-z]+)\b", text_of(surface, part))) - {name}
        for part in (0, 1, 2)
    ]
    assert all(names)
    assert not names[0] & names[1]
    assert not names[1] & names[2]


def test_max_listens_at_another_port_for_each_part():
    (surface,) = (surface for surface in SURFACES if surface.name == "yehu.maxpat")
    for part in (0, 1, 2):
        text = text_of(surface, part)
        assert f"udpreceive {7400 + part}" in text
        assert f"/yehu/subscribe 60 {7400 + part}" in text


def test_files_of_parts_lie_beside_each_other_and_are_checked(tmp_path, command):
    words = ("surfaces", "-o", tmp_path, "--only", "yehu.pd")
    for part in (("--part", 1), ("--part", 2), ()):
        assert command(*words, *part)[0] == 0
    names = ["yehu-part-1.pd", "yehu-part-2.pd", "yehu.pd"]
    assert sorted(path.name for path in tmp_path.iterdir()) == names
    assert command(*words, "--part", 2, "--check")[0] == 0
    (tmp_path / "yehu-part-2.pd").write_text("old")
    code, out, _ = command(*words, "--part", 2, "--check")
    assert (code, "yehu-part-2.pd" in out) == (1, True)
