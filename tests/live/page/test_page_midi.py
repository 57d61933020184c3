"""MIDI keyboards of the browser's own Web MIDI, which come, play, are pulled out and come back."""

import os
import shutil
import subprocess

import pytest
from live.page.browser import HERE, drive

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(shutil.which("cc") is None, reason="there is no cc"),
]


def test_keyboards_play_and_may_be_pulled_out_in_a_note(imitated, tmp_path):
    library, fifo = tmp_path / "alsa_ports.so", tmp_path / "ports"
    flags = ["-O1", "-Wall", "-Wextra", "-Werror", "-shared", "-fPIC"]
    command = ["cc", *flags, HERE / "alsa_ports.c", "-o", library, "-ldl"]
    subprocess.run(command, check=True)
    os.mkfifo(fifo)
    found = drive("page_midi.mjs", imitated, str(library), str(fifo))
    assert found["begun"] == found["again"] == found["left"] == ["BEGIN"]
    assert found["ended"] == found["pulled"] == found["chosen"] == ["END"]
    assert not found["isInvited"]  # to touch a string: it plays
    assert found["names"] == ["All that are connected", "Keys", "Pads"]
    assert found["pitches"] == [72]
