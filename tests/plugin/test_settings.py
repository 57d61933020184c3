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
            at, value = ("/preset", shown["/preset"].choices.index(change)) if is_name else change
            words += [str(shown[at].number), str(value)]
        command = [folder / "settings", *words]
        text = subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()
        name, preset, is_changed, usual = text.split("|")
        return name, shown["/preset"].choices[int(preset)], is_changed == "1", float(usual)

    return changed


VIBRATO, LEVEL = "/playing/vibrato", "/room/level"


def test_the_sound_and_the_room_are_named_apart(settings):
    assert settings() == ("vibrato, chamber", "vibrato", False, 26.0)
    assert settings("hall")[:3] == ("vibrato, hall", "hall", False)
    assert settings("flautando", "hall")[0] == "flautando, hall"
    assert settings("hall", (VIBRATO, 40.0))[0] == "vibrato, changed, hall"
    assert settings("hall", (LEVEL, 0.1))[0] == "vibrato, hall, changed"


def test_a_preset_that_was_changed_is_where_one_steps_from(settings):
    assert settings("flautando", (VIBRATO, 40.0))[:3] == (
        "flautando, changed, chamber",
        "flautando",
        True,
    )


def test_the_usual_value_is_that_of_the_sound(settings):
    for name, usual in ("ordinary", 0.0), ("vibrato", 26.0):
        assert settings(name, (VIBRATO, 40.0))[3] == usual
        assert settings(name, "hall", (VIBRATO, 40.0))[3] == usual
