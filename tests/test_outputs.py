"""No command overwrites what it reads, or what the user made."""

import argparse
from pathlib import Path

import numpy as np
import pytest
import soundfile

from yehu_server.cli import _parser

MAPPING = 'base = "keyboard"\n'


@pytest.fixture(autouse=True)
def _here(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def files(tmp_path) -> dict[str, Path]:
    """Files that commands read."""
    texts = {"w.toml": MAPPING, "below.toml": MAPPING, "p.toml": "version = 1\n[values]\n"}
    steps = "".join(f" {100.0 * step}\n" for step in range(1, 13))
    texts["s.scl"] = f"! s.scl\ns\n 12\n{steps}"
    texts["k.kbm"] = "0\n0\n127\n60\n69\n440.0\n0\n"
    for name, text in texts.items():
        (tmp_path / name).write_text(text)
    return {name: tmp_path / name for name in texts}


def serving(name: str, output: str) -> list[str]:
    words = {
        "w.toml": ["--mapping", "w.toml"],
        "p.toml": ["--preset", "p.toml"],
        "s.scl": ["--tuning", "s.scl"],
        "k.kbm": ["--tuning", "s.scl", "--keyboard-map", "k.kbm"],
    }
    return ["serve", *words[name], output, "out"]


@pytest.mark.parametrize("output", ["--record", "--capture"])
@pytest.mark.parametrize("name", ["w.toml", "p.toml", "s.scl", "k.kbm"])
def test_a_take_does_not_go_over_what_is_read_nor_over_a_link_to_it(
    refused, files, tmp_path, name, output
):
    out, before = tmp_path / "out", files[name].read_text()
    for link in (out.symlink_to, out.hardlink_to):
        link(files[name])
        for more in ([], ["--overwrite"]):
            err = refused(*serving(name, output), *more)
            assert f"out: {output} would overwrite an input" in err
        out.unlink()
    plain = [word if word != "out" else name for word in serving(name, output)]
    assert "would overwrite an input" in refused(*plain, "--overwrite")
    assert files[name].read_text() == before


def test_two_things_do_not_go_to_one_file(refused, tmp_path):
    (tmp_path / "folder").symlink_to(tmp_path)
    for other in ("x.wav", "./x.wav", tmp_path / "x.wav", "folder/x.wav"):
        err = refused("serve", "--record", "x.wav", "--capture", other, "--overwrite")
        assert "--record and --capture would write to the same file" in err
    (tmp_path / "x.wav").write_text("older")
    (tmp_path / "y.wav").hardlink_to(tmp_path / "x.wav")
    (tmp_path / "z.wav").symlink_to("x.wav")
    for other in ("y.wav", "z.wav"):
        assert "to the same file" in refused(
            "serve", "--record", "x.wav", "--capture", other, "--overwrite"
        )
    assert (tmp_path / "x.wav").read_text() == "older"


def test_a_rendering_or_a_replay_does_not_go_over_what_is_read(refused, files, tmp_path):
    (tmp_path / "tune.mid").write_bytes(b"")
    (tmp_path / "i.toml").write_text("")
    (tmp_path / "c").write_text("{}")
    for words in (
        ("render", "tune.mid", "--mapping", "./w.toml", "-o", "w.toml"),
        ("render", "tune.mid", "--preset", "./p.toml", "-o", "p.toml"),
        ("render", "tune.mid", "--instrument", "./i.toml", "-o", "i.toml"),
        ("render", "tune.mid", "-o", tmp_path / "tune.mid"),
        ("replay", "c", "-o", "c"),
    ):
        assert "-o would overwrite an input" in refused(*words, "--overwrite")
    assert files["w.toml"].read_text() == MAPPING


GESTURE = '{"duration": 0.05, "controls": {"bow_force": 0.5, "bow_velocity": 0.2}}'
MADE_FILES = (  # of all that writes data to a file that is named
    ("simulate", "g.json", "-o", "x.npz"),
    ("practise", "-o", "x.json"),
    ("mappings", "convert", "w.toml", "-o", "x.toml"),
    ("score", "write", "t.abc", "-o", "x.jianpu"),
    ("score", "show", "t.abc", "--export-midi", "x.mid"),
    ("build", "tables", "-o", "x.tables"),
    ("follow", "hum.wav", "-o", "x.jsonl"),
    ("body", "fit", "a.csv", "-o", "x.json"),
    ("body", "fit", "a.csv", "-o", "x.toml"),
    ("sweep", "g.json", "--vary", "bow_force=1,2", "-o", "x.npz"),
    ("sweep", "show", "r.npz", "-o", "x.html"),
)


@pytest.mark.parametrize("words", MADE_FILES, ids=" ".join)
@pytest.mark.usefixtures("files")
def test_what_exists_is_replaced_only_where_that_is_asked_for(refused, tmp_path, words):
    (tmp_path / "g.json").write_text(GESTURE)
    (tmp_path / "t.abc").write_text("X:1\nK:C\nCDEF|\n")
    soundfile.write(tmp_path / "hum.wav", 0.5 * np.sin(np.arange(30_000) * 0.0628), 44100)
    older = tmp_path / words[-1]
    older.write_text("older")
    assert f"{words[-1]}: exists; " in (err := refused(*words))
    assert "--overwrite" in err
    assert older.read_text() == "older"


def test_a_file_is_refused_as_a_folder_before_any_work(refused, tmp_path):
    (tmp_path / "file").write_text("mine")
    for words in (
        *(("build", what) for what in ("wasm", "library", "plugin")),
        *(("page",), ("surfaces",), ("dataset", "d.toml"), ("body", "taps")),
    ):
        for path in ("file", "file/below"):
            assert "file: is a file; name a folder" in refused(*words, "-o", path), words


def test_every_command_that_writes_a_file_can_be_told_to_replace_it():
    waiting, writing = [_parser()], []
    while waiting:
        parser = waiting.pop()
        for action in parser._actions:
            if isinstance(action, argparse._SubParsersAction):
                waiting += action.choices.values()
        waiting += parser._actions_by_word.values()
        into = parser.options.get("-o")
        if into is not None and into.metavar != "FOLDER":
            writing.append(parser.prog)
            assert "--overwrite" in parser.options, parser.prog
    assert len(writing) > 9
