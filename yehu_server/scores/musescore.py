"""Read MuseScore's own files through its program, where that is installed."""

from __future__ import annotations

import shutil
import subprocess
import tempfile
from pathlib import Path

from yehu_server.errors import ScoreError
from yehu_server.scores.musicxml.reader import read_musicxml
from yehu_server.scores.score import naming, read_score_bytes
from yehu_server.scores.written.notated import MOST_BYTES, Written

PROGRAMS = (
    "mscore", "musescore", "mscore4portable", "mscore3", "musescore3", "MuseScore4", "MuseScore3",
)  # fmt: skip
LONGEST_S = 120.0


def read_musescore(path: Path) -> Written:
    """Read a file of MuseScore as its program exports it.

    Raises ScoreError, one line naming the file: where it cannot be read, or there is no such
    program, how to export it.
    """
    with naming(path):
        read_score_bytes(path, MOST_BYTES)
        program = next(filter(None, map(shutil.which, PROGRAMS)), None)
        if program is None:
            raise ScoreError(
                "is a file of MuseScore, which is read where MuseScore is installed; or export it "
                "there: File, Export, MusicXML"
            )
        with tempfile.TemporaryDirectory(prefix="yehu-server-") as folder:
            target = Path(folder) / "score.musicxml"
            words = [program, "-o", str(target), str(path.resolve())]
            try:
                subprocess.run(words, check=True, capture_output=True, timeout=LONGEST_S)  # noqa: S603 - no shell
                return read_musicxml(target)
            except (subprocess.SubprocessError, OSError) as error:
                why = type(error).__name__
                raise ScoreError(f"{program} cannot export it ({why}); export it there") from None
            except ScoreError as error:
                raise ScoreError(str(error).removeprefix(f"{target}: ")) from None
