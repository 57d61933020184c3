"""Each line of shell and OSC that a page shows is given, in the order of the page, and succeeds.

The lines of a page share a folder, which has the examples and what readers bring, and a server.
Without ``--all`` examples are cut short, and pages of SLOW are left out. What is never given is in
NOT_GIVEN, with the reason.
"""

import os
import re
import shlex
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import urlsplit

import forks
import mido
import numpy as np
import pytest
import soundfile
from commands import COMMAND
from midi_files import midi_file, notes
from pages import FENCED, PAGES, ROOT, Page
from voices import tune, voice
from web_client import ask

from yehu_server.cli import main
from yehu_server.live.web.server import WebOptions

IN_TEXT = ("yehu-server ", "dask ", "openssl ", "pip ")  # blocks of text that begin so are shell
NOT_GIVEN = {  # patterns of lines
    r"scripts/release\b": "an hour, network: it makes a release and tries it",
    r"scripts/test\b|\.venv/bin/pytest": "hours: these are the tests themselves",
    r"\.venv/bin/python tests/fuzz": "minutes: scripts/test --nightly fuzzes",
    r"scripts/generate|\.venv/bin/python scripts/": "they write this checkout: tests/test_docs.py",
    r"git |cd ": "network",
    r"sudo |python3 -m venv|mkdir |ln |cp ": "root, or they install: scripts/releases/trials.py",
    r".*pw-jack |systemctl |journalctl |loginctl ": "a user's own systemd and PipeWire",
    r"\S*/bin/(pip|yehu-server) ": "network: scripts/releases/trials.py",
    r"pip |dask |openssl |.* --dask ": "network: tests/test_render_cluster.py has a cluster",
    r".* serve .*(--lan|--osc 192)": "network: tests/live/page/test_guests.py",
    r".* practise ": "a quarter of an hour: tests/lab/practising/",
    r".* --practice mine": "what practise finds in a quarter of an hour",
    r".* build (wasm|library|plugin)": "compilers, minutes: tests/ahead/, tests/plugin/",
    r".* serve .*--follow\b": "hardware: a microphone",
    r".* devices$": "hardware",
    r".* learn ": "hardware: tests/test_learn_command.py moves a controller",
    r".* --mapping my.toml": "what the reader adds: tests/test_worked_examples.py",
    r"NUMBA_DISABLE_JIT=1 ": "minutes, uncompiled: tests/test_uncompiled.py",
}
SLOW = {
    *("docs/body.md", "docs/dataset.md", "docs/ensemble.md", "docs/folders.md", "docs/jianpu.md"),
    *("docs/live.md", "docs/parts.md", "docs/playing.md", "docs/render.md", "docs/sections.md"),
    "docs/sweep.md",
}
OWN = {"docs/ensemble.md": "quartet.toml", "presets/README.md": "my-sound.toml"}  # shown on a page
SHORT_S = 2.0  # of an example, without --all


# ---------------------------------------------------------------- what a page has


def lines_of(page: Page) -> Iterator[str]:
    """The lines of shell and OSC of a page, without what stands beside them."""
    for kind, block in FENCED.findall(page.text):
        is_shell = not kind and not re.match(r"[\s│┌]", block)
        if is_shell or (kind == "text" and block.startswith(IN_TEXT)):
            for line in block.replace("\\\n", " ").splitlines():
                yield re.sub(r" {3,}.*", "", re.sub(r" +--", " --", line))


def given(page: Page) -> list[str]:
    return [line for line in lines_of(page) if not any(re.match(each, line) for each in NOT_GIVEN)]


# ---------------------------------------------------------------- what a reader has


@pytest.fixture
def desk(tmp_path, monkeypatch, everything) -> Path:
    """A folder with the examples, and with files of the reader's own, as pages name them."""
    examples = Path(shutil.copytree(ROOT / "examples", tmp_path / "examples"))
    if not everything:
        for path in examples.rglob("*.mid"):
            cut_short(path)
        marks = examples / "marks.musicxml"
        text = re.sub(r'(?s)<measure number="4">.*(?=</part>)', "", marks.read_text("utf-8"))
        marks.write_text(text, "utf-8")
        for path in examples.rglob("*.toml"):
            text = path.read_text(encoding="utf-8")
            path.write_text(re.sub(r"(steps|levels|count) = \d+", r"\1 = 2", text), "utf-8")
    phrase = notes((0.0, 0.3, 69, 80), (0.3, 0.3, 72, 90)) + notes((0.0, 0.6, 77, 80), channel=2)
    for name in ("tune", "a", "b", "old", "opera", "quartet"):
        more = notes((0.0, 0.3, 48, 80), channel=3) + notes((0.0, 0.3, 60, 80), channel=4)
        midi_file(tmp_path / f"{name}.mid", phrase + more if name == "quartet" else phrase)
    songs = mido.MidiFile(type=2, ticks_per_beat=500)
    songs.tracks += 3 * mido.MidiFile(tmp_path / "tune.mid").tracks
    songs.save(tmp_path / "collection.mid")
    (tmp_path / "songs").mkdir()
    shutil.copy(tmp_path / "tune.mid", tmp_path / "songs")
    shutil.copy(examples / "marks.musicxml", tmp_path / "tune.musicxml")
    hum = voice(tune([(57.0, 0.4), (59.0, 0.4)], 16000), 16000)
    soundfile.write(tmp_path / "hum.wav", hum.astype(np.float32), 16000)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def cut_short(path: Path) -> None:
    """Keep the first seconds of a MIDI file, at its usual tempo."""
    file = mido.MidiFile(path)
    for track in file.tracks:
        now, kept = 0, []
        for message in track:
            now += message.time
            if now < 2 * file.ticks_per_beat * SHORT_S or message.is_meta:
                kept.append(message)
        track[:] = kept
    file.save(path)


# ---------------------------------------------------------------- giving a line


class Server:
    """A page's server, which starts with the first line that needs it."""

    def __init__(self, make_live) -> None:
        self._make = make_live

    def start(self) -> None:
        if not hasattr(self, "live"):
            self.live = self._make(parts=3, http=WebOptions(("127.0.0.1", 0)))
            self.client = self.live.client()

    def send(self, line: str) -> None:
        """Send a message: it is not answered with an error."""
        self.start()
        address, *words = shlex.split(line)
        words = [str(self.client.port) if word == "7400" else word for word in words]
        self.client.send(address.removeprefix("/yehu"), *map(argument, words))
        self.client.send("/ping", line)
        while (answer := self.client.next()).address != "/yehu/pong":
            assert answer.address != "/yehu/error", answer

    def ask(self, url: str) -> None:
        self.start()
        path = urlsplit(url)
        query = f"?{path.query}" if path.query else ""
        assert ask(self.live.server.web.port, path.path + query).status == 200


def argument(word: str) -> int | float | str:
    for kind in (int, float):
        try:
            return kind(word)
        except ValueError:
            pass
    return word


def shell(line: str) -> int:
    ours = f"{shlex.quote(sys.executable)} -c {shlex.quote(COMMAND)}"
    line = line.replace("yehu-server", ours, 1)
    return subprocess.run(["/bin/sh", "-c", line], check=False).returncode


def serve(words: list[str]) -> int:
    """Serve for a moment, at free ports, without devices and a browser."""
    here = ["--duration", "0.3", "--audio-device", "null", "--midi-api", "none"]
    here += ["--osc", "127.0.0.1:0", "--http", "127.0.0.1:0"]
    return forks.run("serve", *words, *here, env={**os.environ, "BROWSER": "true"}).returncode


@pytest.mark.parametrize(
    "of",
    [
        pytest.param(page, marks=[pytest.mark.slow] * (page.name in SLOW), id=page.name)
        for page in PAGES
        if given(page)
    ],
)
def test_each_line_of_a_page_can_be_given_in_order(of, desk, make_live, subtests):
    server = Server(make_live)
    if of.name in OWN:
        (desk / OWN[of.name]).write_text(of.blocks("toml")[0], encoding="utf-8")
    for line in given(of):
        with subtests.test(line):
            words = shlex.split(line)
            if line.startswith("/"):
                server.send(line)
            elif words[0] == "curl":
                server.ask(words[1])
            elif re.search(r"[<>]", line):
                assert shell(line) == 0
            elif words[1] == "serve":
                assert serve(words[2:]) == 0
            else:
                assert main(words[1:]) == 0
