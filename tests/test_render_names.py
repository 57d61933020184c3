"""A rendering depends on what its command names, not on what the user learned or saved."""

import argparse
import json
import re
from pathlib import Path

import mido
import pytest
from midi_files import midi_file, notes

from yehu_server.cli.terminal import calibrating
from yehu_server.playing.learn import learn
from yehu_server.playing.learner import LearnedSource
from yehu_server.playing.mapping import load, mapping_folder

# What a folder of presets may hold.
LOUD = 'version = 1\nprogram = 3\n[values]\n"/playing/pressure" = 0.9\n'


@pytest.fixture
def tune(tmp_path) -> Path:
    changes = (
        (0.0, mido.Message("program_change", program=2)),
        (0.0, mido.Message("control_change", control=20, value=3)),
    )
    return midi_file(tmp_path / "tune.mid", [*changes, *notes((0.0, 0.125, 67, 90))])


pytestmark = pytest.mark.usefixtures("config_home")


@pytest.fixture
def rendered(command, tune, tmp_path):
    """Render the tune; return the sound, the JSON printed, and stderr."""

    def run(*words: object) -> tuple[bytes, dict, str]:
        out = tmp_path / "out.wav"
        code, printed, err = command("render", tune, "-o", out, "--json", *words)
        assert code == 0, err
        return out.read_bytes(), json.loads(printed), err

    return run


def test_what_was_learned_live_changes_no_rendering_but_where_it_is_named(rendered, tmp_path):
    based = tmp_path / "pedals.toml"
    based.write_text('base = "keyboard"\n')
    before, told, err = rendered()
    shipped = mapping_folder() / "keyboard.toml"
    assert told["mapping"] == {"name": "keyboard", "files": [str(shipped)]}
    assert err == ""
    of_base = rendered("--mapping", based)[0]
    _, own = learn(
        load("keyboard"), "/playing/pressure", LearnedSource("cc 20"), soft=False, only=True
    )
    for words in ((), ("--mapping", "keyboard")):
        after, told, err = rendered(*words)
        assert after == before
        assert told["mapping"]["files"] == [str(shipped)]
        assert "--mapping mine/keyboard is your own" in err
    assert rendered("--mapping", based)[0] == of_base
    for name in ("mine/keyboard", own):
        sound, told, err = rendered("--mapping", name)
        assert sound != before
        assert told["mapping"]["files"] == [str(own), str(shipped)]
        assert err == ""


def test_a_preset_of_ones_own_counts_where_it_is_named(rendered, config_home):
    own = config_home / "yehu-server" / "presets"
    named, programs = ("--preset", "flautando"), ("--programs",)
    before = [rendered(*words)[0] for words in (named, programs)]
    own.mkdir(parents=True)
    (own / "flautando.toml").write_text(LOUD)
    assert [rendered(*words)[0] for words in (named, programs)] == before
    sound, told, _ = rendered("--preset", "mine/flautando")
    assert sound != before[0]
    assert told["preset"] == str(own / "flautando.toml")
    assert rendered(*named, "--presets", own)[0] == sound
    assert rendered(*programs, "--presets", own)[0] != before[1]


def test_what_is_named_wrongly_is_answered_with_what_there_is(command, tmp_path):
    score = tmp_path / "tune.text"
    score.write_text("title=t\n1=F 4/4 4=60\n\n1 2 3 4\n")
    out = tmp_path / "out.wav"
    tune = Path(__file__).parents[1] / "examples" / "tunes" / "twinkle.jianpu"
    for words, said in (
        (("render", tune, "--room", "church"), "no room 'church' (there are: chamber, "),
        (("render", tune, "--room", "haal"), "); did you mean hall?"),
        (("render", tune, "--preset", "halll"), "); did you mean hall?"),
        (("render", tune, "--mapping", "wnd"), "); did you mean wind?"),
        (
            ("render", tune, "--tuning", "chaozhou-seven"),
            "; or name a file); did you mean chaozhou-",
        ),
        (
            ("render", tune, "--room", "flautando"),
            "flautando: not a room (it sets /bow/noise; there are: chamber, courtyard, ",
        ),
        (("render", score), "it is text; scores in text are named .jianpu, .abc or .musicxml"),
        (("build", "vst3"), "'vst3' is not one of wasm, library, plugin, tables"),
    ):
        code, _, err = command(*words, "-o", out)
        assert (code, said in err) == (2, True), err
    for words in (("render", tune, "-o", out), ("serve",), ("presets", "list")):
        for path in (tmp_path / "none", tune):
            code, _, err = command(*words, "--presets", path)
            assert code == 2
            assert f"{path.name}: no such folder; --preset chooses a preset" in err


def test_json_names_the_part_and_what_was_chosen_moved_and_taken(command, tmp_path):
    file = mido.MidiFile(ticks_per_beat=500, charset="utf8")
    bend = (0.0, mido.Message("pitchwheel", pitch=800))
    low = notes(*((0.125 * at, 0.125, key, 80) for at, key in enumerate((60, 62, 64))))
    bass = notes((0.0, 0.375, 31, 90), channel=2)
    for name, events in (("二胡", [bend, *low]), ("低音", bass)):
        track, now = file.add_track(name), 0
        for time, message in sorted(events, key=lambda each: each[0]):
            track.append(message.copy(time=round(1000 * time) - now))
            now = round(1000 * time)
    file.save(tmp_path / "film.mid")
    words = ("render", tmp_path / "film.mid", "-o", tmp_path / "out.wav", "--tail", 0)
    code, printed, err = command(*words, "--json", "--rate", 22050)
    assert code == 0, err
    fields = json.loads(printed)
    assert fields["parts"][0]["name"] == "二胡" in printed
    said = (
        "film: plays 二胡; also there: 低音",
        "film: moved to fit",
        "no bend range in the file: 2",
    )
    assert all(map(str.startswith, fields["warnings"], said))
    assert len(fields["warnings"]) == len(said)
    assert not fields["timing_shaped"]  # of a phrase so short
    bent = ("--overwrite", "--quiet", "--json", "--set", "/playing/bend_range=12")
    assert len(json.loads(command(*words, *bent)[1])["warnings"]) == 2


def test_the_report_says_that_rubato_shapes_the_timing(command, tmp_path):
    tune = notes(*((0.25 * at, 0.24, 67 + at % 5, 80) for at in range(9)))
    words = ("render", midi_file(tmp_path / "tune.mid", tune), "-o", tmp_path / "out.wav")
    words += ("--overwrite", "--dry", "--rate", 22050, "--tail", 0)
    assert "timing shaped (--rubato 0 keeps" in command(*words)[1]
    assert "timing shaped" not in command(*words, "--rubato", 0)[1]


def test_the_wait_for_a_calibration_is_announced_once_before_it(capsys):
    for is_quiet, lines in ((False, 1), (True, 0)):
        with calibrating(argparse.Namespace(quiet=is_quiet), 192_000.0) as progress:
            progress(0, 2)
            assert len(capsys.readouterr().err.splitlines()) == lines
            progress(1, 2)
        assert not capsys.readouterr().err


@pytest.mark.parametrize(
    "words",
    [
        "render none.mid -o out.wav",
        "render none.abc -o out.wav",
        "render TUNE -o out.wav --preset none.toml",
        "render TUNE -o out.wav --mapping none.toml",
        "render TUNE -o out.wav --instrument none.toml",
        "render TUNE -o out.wav --ensemble none.toml",
        "render TUNE -o out.wav --practice none.json",
        "render TUNE -o out.wav --tuning none.scl",
        "replay none.jsonl -o out.wav",
        "score show none.mid",
        "simulate none.json -o out.npz",
        "mappings check none.toml",
        "presets show none.toml",
        "serve --config none.toml",
    ],
)
def test_every_command_says_of_a_missing_file_the_same(refused, tmp_path, monkeypatch, words):
    tune = Path(__file__).parents[1] / "examples" / "tunes" / "twinkle.jianpu"
    monkeypatch.chdir(tmp_path)
    (name,) = re.findall(r"none\.\w+", words)
    said = refused(*(str(tune) if word == "TUNE" else word for word in words.split()))
    assert said == f"yehu-server: {name}: no such file\n"


def test_all_that_is_wrong_in_a_file_is_told_at_once(command, tmp_path):
    tune = Path(__file__).parents[1] / "examples" / "tunes" / "twinkle.jianpu"
    wrong, config = tmp_path / "mine.toml", tmp_path / "serve.toml"
    wrong.write_text('nme = "mine"\n[[bind]]\nsource = "cc 300"\ntarget = "/bow/force"\n')
    config.write_text("rate = 1\nmapping = 'mine.toml'\nblocksize = 'x'\n")
    for words, lines in (
        (("render", tune, "-o", tmp_path / "out.wav", "--mapping", wrong), [1, 3, 4]),
        (("mappings", "show", wrong), [1, 3, 4]),
        (("serve", "--config", config), [1, 3]),
    ):
        code, _, err = command(*words)
        assert code == 2
        assert [int(each) for each in re.findall(r"\.toml:(\d+): ", err)] == lines
    config.write_text(f"mapping = '{wrong.as_posix()}'\n")
    code, _, err = command("serve", "--config", config)
    assert (code, err.count(f"{config}:1: mapping: {wrong.as_posix()}:")) == (2, 3)
