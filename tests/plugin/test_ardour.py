"""LV2 and VST3 in Ardour without its window: what it exports of a track with a MIDI region."""

import os
import shutil
import subprocess
from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np
import pytest
import soundfile
from plugin.sounds import FRAMES, PHRASE, TICK_FRAMES, by_library, write_midi

from yehu_server.plugin.header import LV2_URI, VST3_ID

HERE = Path(__file__).parent
LUA, EXPORT = (
    next(filter(None, (shutil.which(f"ardour{number}-{tool}") for number in (9, 8, 7))), None)
    for tool in ("lua", "export")
)
SCANNER = next(iter(sorted(Path("/usr/lib").glob("ardour*/ardour-vst3-scanner"))), None)
FORMATS = {"LV2": LV2_URI, "VST3": "".join(f"{word:08X}" for word in VST3_ID)}
SUPERCLOCKS = 282_240_000  # of a second, in sessions
BLOCK = 64
LIMIT_S = 120
TRIES = 5  # Ardour 7.3 overwrites its memory in one export of twenty: it ends, waits, or roars

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(LUA is None or EXPORT is None, reason="there is no Ardour"),
]


@pytest.fixture
def ardour(built, tmp_path):
    """Run a program of Ardour's, with a home of its own in which only this plug-in is installed."""
    environment = {**os.environ, "HOME": str(tmp_path), "LV2_PATH": str(tmp_path / ".lv2")}
    for ending in ("lv2", "vst3"):
        shutil.copytree(built / f"Yehu.{ending}", tmp_path / f".{ending}" / f"Yehu.{ending}")

    def run(*command: object) -> subprocess.CompletedProcess[str]:
        words = [str(word) for word in command]
        return subprocess.run(
            words, env=environment, capture_output=True, text=True, check=False, timeout=LIMIT_S
        )

    return run


def scan(ardour, folder: Path) -> None:
    """Let Ardour's scanner check the VST3 plug-in, whose word has to be newer than the file."""
    programs = SCANNER.parent
    environment = ("env", f"LD_LIBRARY_PATH={programs}", f"ARDOUR_DLL_PATH={programs}")
    done = ardour(*environment, SCANNER, "-f", folder / ".vst3" / "Yehu.vst3")
    assert "Found Plugin: Yehu" in done.stdout, done.stderr
    for path in (folder / ".vst3" / "Yehu.vst3").rglob("*"):
        os.utime(path, (0, 0))


def add_region(session: Path) -> None:
    """Put the phrase as a MIDI file into a session, and a region of it onto the track."""
    write_midi(session / "interchange" / "session" / "midifiles" / "phrase.mid", PHRASE, FRAMES)
    path = session / "session.ardour"
    tree = ET.parse(path)  # noqa: S314 - Ardour has just written it
    source, region, span = "90001", "90002", "90003"
    ET.SubElement(
        tree.find("Sources"), "Source", name="phrase.mid", type="midi", id=source, flags=""
    )
    attributes = {"position": "b0", "start": "b0", "length": f"b{int(FRAMES / TICK_FRAMES)}@b0"}
    attributes |= {"name": "phrase", "type": "midi", "id": region, "opaque": "1"}
    attributes |= {"source-0": source, "master-source-0": source, "first-edit": "nothing"}
    ET.SubElement(tree.find("Playlists/Playlist"), "Region", attributes)
    attributes = {"start": "a0", "end": f"a{SUPERCLOCKS * FRAMES // 48000}", "name": "session"}
    attributes |= {"id": span, "flags": "IsSessionRange", "locked": "0"}
    ET.SubElement(tree.find("Locations"), "Location", attributes)
    tree.write(path, xml_declaration=True, encoding="UTF-8")


def exported(ardour, session: Path, into: Path) -> np.ndarray:
    """The samples that Ardour exports of a session [shape=(frames, 2)]."""
    command = (EXPORT, "-b", "float", "-s", "48000", "-o", into, session, session.name)
    said = []
    for _ in range(TRIES):
        try:
            done = ardour(*command)
        except subprocess.TimeoutExpired as error:
            said.append(str(error))
            continue
        said.append(done.stderr)
        if done.returncode == 0:
            samples = soundfile.read(into, dtype="float32", always_2d=True)[0]
            if len(samples) == FRAMES and np.abs(samples).max() <= 1.0:
                return samples
    raise AssertionError(said)


@pytest.mark.parametrize("name", FORMATS)
def test_ardour_exports_the_samples_of_the_library(ardour, library, tmp_path, name):
    if name == "VST3":
        if SCANNER is None:
            pytest.skip("there is no scanner of VST3")
        scan(ardour, tmp_path)
    session = tmp_path / "session"
    done = ardour(LUA, HERE / "ardour_session.lua", session, session.name, name, FORMATS[name])
    assert done.returncode == 0, done.stdout + done.stderr
    add_region(session)
    samples = exported(ardour, session, tmp_path / "sound.wav")
    wanted = by_library(library, PHRASE, FRAMES)
    # Ardour's export begins 16 frames late at times.
    begin, wanted_begin = (np.flatnonzero(sound.any(axis=1))[0] for sound in (samples, wanted))
    assert abs(begin - wanted_begin) < BLOCK
    count = FRAMES - BLOCK - wanted_begin
    assert np.array_equal(samples[begin:][:count], wanted[wanted_begin:][:count])
