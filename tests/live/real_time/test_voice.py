"""A voice at an audio input is followed: over JACK, by another program that sings."""

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

RATE = 48000
SINGER = Path(__file__).with_name("singer.py")
NOTES = (57, 60, 64)

pytestmark = pytest.mark.slow


def voice() -> np.ndarray:
    """Notes of half a second, with rests between them."""
    time = np.arange(RATE // 2) / RATE
    fade = np.clip(np.minimum(time, time[::-1]) / 0.01, 0.0, 1.0)
    rest = np.zeros(RATE // 2)
    parts = [rest]
    for note in NOTES:
        phase = 2.0 * np.pi * 440.0 * 2.0 ** ((note - 69.0) / 12.0) * time
        parts += [0.1 * fade * sum(np.sin(k * phase) / k for k in range(1, 9)), rest]
    return np.concatenate(parts)


def sing(jackd, folder: Path) -> None:
    np.save(folder / "voice.npy", voice())
    words = [jackd.name, "yehu-server voice:in_0", str(folder / "voice.npy")]
    subprocess.run(
        [sys.executable, SINGER, *words], env=jackd.environment, check=True, timeout=60.0
    )


def test_what_is_sung_is_played_and_ends_with_the_input(jackd, serve, tmp_path):
    jackd.start(128)
    take = tmp_path / "take.jsonl"
    server = serve("--follow", "--midi-api", "none", "--capture", take)
    server.said("following system")
    sing(jackd, tmp_path)
    server.close()
    commands = [json.loads(line) for line in take.read_text().splitlines()[1:]]
    begun = [command for command in commands if "begin" in command]
    assert [round(pitch) for *_, pitch in begun] == [note + 12 for note in NOTES]
    assert sum("end" in command for command in commands if isinstance(command, list)) >= len(NOTES)


def test_an_input_that_is_not_there_is_reported_and_the_rest_plays(jackd, serve):
    jackd.start(128)
    server = serve("--follow", "no such microphone", "--midi-api", "none")
    server.said("no voice to follow: no audio input matches 'no such microphone'")
    server.osc().send("/note", 69, 80)
    server.close()


@pytest.mark.parametrize("number", [signal.SIGSTOP, signal.SIGKILL])
def test_an_input_that_stalls_or_goes_holds_no_note_and_is_followed_again(
    number, jackd, serve, tmp_path, until
):
    """A sound server that is stopped says nothing; the input's silence shows it."""
    jackd.start(128)
    take = tmp_path / "take.jsonl"

    def count(kind: str) -> int:
        lines = take.read_text().splitlines()[1:]  # the last may be cut off
        return sum(f'"{kind}"' in line for line in lines)

    server = serve("--follow", "--midi-api", "none", "--capture", take)
    server.said("following system", 60.0)
    phase = 2.0 * np.pi * 220.0 * np.arange(60 * RATE) / RATE
    np.save(tmp_path / "voice.npy", 0.1 * sum(np.sin(k * phase) / k for k in range(1, 9)))
    words = [jackd.name, "yehu-server voice:in_0", str(tmp_path / "voice.npy")]
    singer = subprocess.Popen([sys.executable, SINGER, *words], env=jackd.environment)
    try:
        until(lambda: take.exists() and count("begin") > 0, "a note", 60.0)
        said = len(server.lines)
        os.kill(jackd.pid, number)
        server.said("is gone; it is followed again", 60.0, said)
    finally:
        singer.kill()
        singer.wait()
    until(lambda: count("end") >= count("begin"), "the end of the note", 60.0)
    if number == signal.SIGSTOP:
        os.kill(jackd.pid, signal.SIGCONT)
    else:
        jackd.restart()
    server.said("following system", 60.0, said)
    server.close()
