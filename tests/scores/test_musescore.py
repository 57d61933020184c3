"""Files of MuseScore are read as its program exports them, with a screen or without."""

import shutil
import sys

import pytest
from musicxml_text import note, score

from yehu_server.errors import ScoreError
from yehu_server.scores.reading import read_written

# Writes what it is asked to, and how it was started.
PROGRAM = """#!/bin/sh
echo "$0 $QT_QPA_PLATFORM" >"$(dirname "$0")/started"
cp "$(dirname "$0")/made.musicxml" "$2"
"""


@pytest.fixture
def tune(tmp_path, monkeypatch):
    """A file of MuseScore, and a folder for programs that is the only one."""
    monkeypatch.setenv("PATH", str(tmp_path))
    for name in ("cp", "dirname"):
        (tmp_path / name).symlink_to(str(shutil.which(name, path="/bin:/usr/bin")))
    path = tmp_path / "tune.mscz"
    path.write_bytes(b"PK\x03\x04")
    (tmp_path / "made.musicxml").write_text(score(note("G4", 1)), encoding="utf-8")
    return path


def install(folder, name, text=PROGRAM):
    (folder / name).write_text(text)
    (folder / name).chmod(0o755)


@pytest.mark.skipif(sys.platform == "win32", reason="has no shell scripts")
def test_the_newest_program_exports_it(tune, monkeypatch):
    for name in ("mscore", "mscore3"):
        install(tune.parent, name)
    for screen, platform in ((None, "offscreen"), (":0", "")):
        monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
        monkeypatch.delenv("QT_QPA_PLATFORM", raising=False)
        monkeypatch.delenv("DISPLAY", raising=False)
        if screen:
            monkeypatch.setenv("DISPLAY", screen)
        monkeypatch.setattr(sys, "platform", "linux")
        assert [each.pitch for each in read_written(tune).parts[0].notes] == [67.0]
        started = (tune.parent / "started").read_text().rstrip("\n")
        assert started == f"{tune.parent / 'mscore3'} {platform}"


@pytest.mark.skipif(sys.platform == "win32", reason="has no shell scripts")
def test_a_file_that_is_not_exported_is_refused_in_a_line(tune):
    with pytest.raises(ScoreError, match=r"^\S*tune\.mscz: is a file of MuseScore, .*Export"):
        read_written(tune)
    install(tune.parent, "mscore", "#!/bin/sh\nexit 40\n")
    with pytest.raises(ScoreError, match=r"tune\.mscz: \S*mscore cannot export it \(CalledProc"):
        read_written(tune)
    (tune.parent / "made.musicxml").write_text("<score/>", encoding="utf-8")
    install(tune.parent, "mscore")
    with pytest.raises(ScoreError, match=r"^\S*tune\.mscz: is not a MusicXML score"):
        read_written(tune)
