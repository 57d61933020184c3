"""Read what MuseScore exports of its own files, where its program is installed."""

import os
import shutil
import subprocess
import tempfile
from pathlib import Path

from yehu_server.errors import ScoreError
from yehu_server.scores.musicxml.reader import read_musicxml
from yehu_server.scores.score import errors_name, read_score_bytes
from yehu_server.scores.written.notated import MAX_BYTES, Written
from yehu_server.system.processes import needs_no_screen

# The newest first: an older one does not read its files. `mscore` is MuseScore 2 on Debian.
PROGRAMS = (
    "MuseScore4", "mscore4portable", "MuseScore3", "musescore3", "mscore3", "musescore", "mscore",
)  # fmt: skip
SCREENS = {"DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM"}
LONGEST_S = 120.0


def read_musescore(path: Path) -> Written:
    """Read a file of MuseScore as its program exports it.

    Raises ScoreError, one line naming the file: where it cannot be read, or there is no such
    program, how to export it.
    """
    with errors_name(path):
        read_score_bytes(path, MAX_BYTES)
        with tempfile.TemporaryDirectory(prefix="yehu-server-") as folder:
            target = Path(folder) / "score.musicxml"
            export(path, target)
            try:
                return read_musicxml(target)
            except ScoreError as error:
                raise ScoreError(str(error).removeprefix(f"{target}: ")) from None


def export(path: Path, target: Path) -> None:
    """Let MuseScore write a score as a file; raises ScoreError, without the file's name."""
    program = next(filter(None, map(shutil.which, PROGRAMS)), None)
    if program is None:
        raise ScoreError(
            "is a file of MuseScore, which is read where MuseScore is installed; or export it "
            "there: File, Export, MusicXML"
        )
    words = [program, "-o", str(target), str(path.resolve())]
    environment = needs_no_screen() | os.environ
    try:
        subprocess.run(  # noqa: S603 - no shell
            words, check=True, capture_output=True, timeout=LONGEST_S, env=environment
        )
    except (subprocess.SubprocessError, OSError) as error:
        why = type(error).__name__
        raise ScoreError(f"{program} cannot export it ({why}); export it there") from None
