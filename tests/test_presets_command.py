"""``yehu-server presets``, and presets on the command line of ``render``."""

import json
import os
from pathlib import Path

import mido
import pytest
from midi_files import midi_file, notes

from yehu_server.playing.preset_folders import Presets

SHIPPED = Presets(Path(os.devnull))
HEAD = "version = 1\n"


@pytest.fixture
def own(tmp_path) -> Path:
    folder = tmp_path / "own"
    folder.mkdir()
    return folder


def test_presets_are_listed_with_their_programs(command, own):
    (own / "mine.toml").write_text(HEAD + 'about = "wild"\n')
    (own / "bad.toml").write_text("version = 9\n")
    code, out, err = command("presets", "list", "--presets", own)
    assert code == 0
    head, _, rest = out.partition("rooms, with their MIDI programs:\n")
    first, *sounds = [line.split()[0] for line in head.splitlines()]
    rooms = [line.split()[0] for line in rest.splitlines()]
    assert first == "sounds,"
    assert {"hall", "dry", "chamber", "study", "courtyard"} <= {*rooms}
    assert sorted([*sounds, *rooms]) == sorted([*SHIPPED.names(), "mine"])
    assert "your own: wild" in out
    assert "bad:1: version: 9 is newer" in err
    rows = json.loads(command("presets", "list", "--json", "--presets", own)[1])
    assert rows["mine"] == {"program": None, "about": "wild", "own": True}
    assert rows["tremolo"]["own"] is False


def test_a_preset_is_shown_with_all_its_values(subtests, command):
    for name in SHIPPED.names():
        with subtests.test(name=name):
            preset = SHIPPED.load(name)
            shown = json.loads(command("presets", "show", name, "--json")[1])
            assert shown["values"] == preset.values
            assert (shown["program"], shown["about"]) == (preset.program, preset.about)
            code, out, _ = command("presets", "show", name)
            assert code == 0
            for address in preset.values:
                assert address in out


def test_all_that_is_wrong_with_each_file_is_reported(command, tmp_path):
    right, first, second = (tmp_path / f"{name}.toml" for name in ("right", "first", "second"))
    right.write_text(HEAD + '[values]\n"/playing/vibrato" = 5\n"/a/b" = 3\n')
    code, out, err = command("presets", "check", right)
    assert (code, out) == (0, f"{right}: valid, 1 values\n")
    assert "unknown parameter '/a/b'" in err
    values = '"/playing/vibrato" = 500\n"/bow/speed" = 1\n"/playing/volume" = "loud"\n'
    first.write_text(f"{HEAD}program = 0\nabout = 3\nwho = 1\n[values]\n{values}")
    second.write_text(HEAD + "values = 3\nprogram = 129\n")
    right.write_text(HEAD)
    code, out, err = command("presets", "check", first, second, right, tmp_path / "missing.toml")
    assert (code, out) == (2, f"{right}: valid, 0 values\n")
    *lines, missing = err.splitlines()
    assert "missing.toml: no such file" in missing
    assert [line.split(": ")[1] for line in lines] == [
        *(f"{first}:{number}" for number in (2, 3, 4, 6, 7, 8)),
        *(f"{second}:{number}" for number in (2, 3)),
    ]
    for what in ("who", "about", "program", "500 is not", "/bow/speed: is moved", "volume"):
        assert any(what in line for line in lines[:6]), what


# ---------------------------------------------------------------- rendering


@pytest.fixture
def rendered(command, tmp_path):
    """Render a note after program changes; the bytes written, and the report."""
    paths = iter(range(100))

    def run(*words: object, programs: tuple[int, ...] = ()) -> tuple[bytes, str]:
        changes = [(0.0, mido.Message("program_change", program=n - 1)) for n in programs]
        score = midi_file(tmp_path / "in.mid", [*changes, *notes((0.0, 0.25, 77, 90))])
        target = tmp_path / f"{next(paths)}.wav"
        code, out, err = command("render", score, "-o", target, "--tail", 0, *words)
        assert code == 0, err
        return target.read_bytes(), out + err

    return run


def test_a_program_change_of_a_file_acts_only_if_asked_for(rendered):
    plain, _ = rendered()
    assert rendered(programs=(6,))[0] == plain
    selected, _ = rendered("--programs", programs=(6,))
    assert selected != plain
    assert rendered("--programs", programs=(6,))[0] == selected
    assert rendered("--preset", "tremolo")[0] == selected
    assert rendered("--programs", programs=(6, 1))[0] == plain


def test_what_is_set_wins_over_a_preset(rendered):
    words = ("--set", "/playing/tremolo=0", "--set", "/playing/attack=40")
    words += ("--set", "/playing/speed=0.2")
    assert rendered("--preset", "tremolo", *words)[0] == rendered()[0]
    programs = rendered("--programs", *words, programs=(6,))[0]
    assert programs == rendered()[0]
