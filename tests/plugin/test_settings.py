"""The plug-in's settings: which sound and room they are, and which values are usual."""

import shutil
import subprocess

import pytest
from plugin.conftest import HERE

from yehu_server.plugin import build as building


@pytest.fixture(scope="module")
def settings(tmp_path_factory, shown):
    """Change parameters, by address and value, or by the name of a preset; what they then are."""
    if shutil.which("g++") is None:
        pytest.skip("there is no g++")
    folder = tmp_path_factory.mktemp("settings")
    building.write_header(folder)
    sources = [
        HERE / "settings.cpp",
        *(building.SOURCE / f"{name}.cpp" for name in ("settings", "text")),
    ]
    flags = ["-std=c++17", "-Wall", "-Wextra", "-Werror", f"-I{building.SOURCE}", f"-I{folder}"]
    command = ["g++", *flags, *map(str, sources), "-o", str(folder / "settings")]
    subprocess.run(command, check=True)

    def changed(*changes):
        words = []
        for change in changes:
            is_name = isinstance(change, str)
            at = "/room" if change in shown["/room"].choices else "/preset"
            at, value = (at, shown[at].choices.index(change)) if is_name else change
            words += [str(shown[at].number), str(value)]
        command = [folder / "settings", *words]
        text = subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()
        sound, last, room, last_room, vibrato, level = text.split("|")
        chosen = shown["/preset"].choices[int(last)], shown["/room"].choices[int(last_room)]
        return (sound, room), chosen, (float(vibrato), float(level))

    return changed


VIBRATO, LEVEL = "/playing/vibrato", "/room/level"


def test_the_sound_and_the_room_are_chosen_apart(settings):
    assert settings() == (("vibrato", "chamber"), ("vibrato", "chamber"), (26.0, 0.45))
    assert settings("hall")[0] == ("vibrato", "hall")
    assert settings("hall", "flautando")[0] == ("flautando", "hall")
    assert settings("hall", (VIBRATO, 40.0))[0] == ("vibrato, changed", "hall")
    assert settings("hall", (LEVEL, 0.1))[0] == ("vibrato", "hall, changed")
    assert settings("hall", (LEVEL, 0.1), (LEVEL, 1.0))[0] == ("vibrato", "hall")


def test_what_was_changed_is_where_one_steps_from(settings):
    moves = "flautando", "hall", (VIBRATO, 40.0), (LEVEL, 0.1)
    assert settings(*moves)[:2] == (("flautando, changed", "hall, changed"), ("flautando", "hall"))
    assert settings(*moves, "dry", "ordinary")[0] == ("ordinary", "dry")


def test_the_usual_value_is_that_of_the_sound_or_room(settings):
    for name, usual in ("ordinary", 0.0), ("vibrato", 26.0):
        assert settings(name, (VIBRATO, 40.0))[2] == (usual, 0.45)
        assert settings(name, "hall", (VIBRATO, 40.0), (LEVEL, 0.3))[2] == (usual, 1.0)
