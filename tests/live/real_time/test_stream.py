"""``yehu-server serve`` as a command on a real audio server: sound, files, exit."""

import json
import os
import signal
import subprocess
import time
from pathlib import Path

import forks
import numpy as np
import pytest
import soundfile

from yehu_server.cli import main
from yehu_server.rendering.replay import blocks
from yehu_server.scores.capture import read_capture

RATE = 48000
DEVICE = "system, JACK Audio Connection Kit"
TRIES = 4

slow = pytest.mark.slow


def first_sound(samples: np.ndarray) -> int:
    return int(np.flatnonzero(samples)[0])


def play(osc, seconds: float) -> None:
    """Play notes and bends for some seconds."""
    end = time.monotonic() + seconds
    note = 0
    while time.monotonic() < end:
        note += 1
        osc.send("/note", 65 + note % 12, 60 + 5 * (note % 10))
        for bend in range(10):
            osc.send("/bend", 0.1 * bend)
            time.sleep(0.01)
        osc.send("/note/off", 65 + note % 12)


def take(path: Path) -> np.ndarray:
    return soundfile.read(path, dtype="float32")[0]


def replayed(folder: Path) -> np.ndarray:
    """A replay of the capture."""
    words = ["replay", str(folder / "take.jsonl"), "-o", str(folder / "again.wav"), "--quiet"]
    assert main(words) == 0
    return take(folder / "again.wav")


def files(folder: Path) -> tuple[object, ...]:
    return ("--record", folder / "take.wav", "--capture", folder / "take.jsonl")


# ---------------------------------------------------------------- what is heard


@pytest.mark.parametrize(("channels", "block"), [(1, 128), pytest.param(6, 100, marks=slow)])
def test_the_device_gets_what_is_recorded_on_every_channel(
    channels, block, jackd, serve, recorder, tmp_path
):
    # JACK without real-time rights is sometimes late: only whole recordings count.
    jackd.start(1024, channels=6)
    words = ("--midi-api", "none", "--channels", channels, "--blocksize", block)
    server = serve(*words, *files(tmp_path))
    osc = server.osc()
    server.said(f"playing on {DEVICE}")
    listener = recorder(channels).connected()
    takes = []
    while len(takes) < TRIES and not any(heard.is_whole for heard in takes):
        time.sleep(0.3)  # until the last note has rung out
        listener.forget()
        play(osc, 0.5)
        takes.append(listener.recording())
    underruns = osc.status()["underruns"]
    assert server.end() == 0

    played = take(tmp_path / "take.wav")
    whole = [heard for heard in takes if heard.is_whole]
    if not whole:
        pytest.skip(f"JACK was late in each of {TRIES} takes ({underruns} under-runs)")
    heard = whole[0].samples.T
    sound = heard[first_sound(np.abs(heard).max(axis=1)) :]
    assert len(sound) > 0.3 * RATE
    assert np.abs(sound).max() > 0.01
    # Left and right in turn; a single channel has the mean of both, which is rounded otherwise.
    expected = played[:, np.arange(channels) % 2] if channels > 1 else played.mean(axis=1)[:, None]
    slack = 0.0 if channels > 1 else 1e-7
    begins = np.abs(expected[: len(expected) - len(sound), 0] - sound[0, 0]) <= slack
    same = [
        place
        for place in np.flatnonzero(begins)
        if (np.abs(expected[place : place + len(sound)] - sound) <= slack).all()
    ]
    assert len(same) == 1
    np.testing.assert_array_equal(replayed(tmp_path), played)


@pytest.mark.slow
def test_it_plays_at_the_devices_own_rate_on_no_more_channels_than_it_has(jackd, serve, tmp_path):
    jackd.start(512, rate=44100, channels=2)
    server = serve("--midi-api", "none", "--channels", 8, *files(tmp_path))
    server.said(f"playing on {DEVICE} at 44100 Hz", 120.0)
    ports = jackd.ports()
    assert "yehu-server:out_1" in ports
    assert "yehu-server:out_2" not in ports
    assert server.end() == 0
    assert soundfile.info(tmp_path / "take.wav").samplerate == 44100
    np.testing.assert_array_equal(replayed(tmp_path), take(tmp_path / "take.wav"))


# ---------------------------------------------------------------- how it ends


@pytest.mark.parametrize(
    "number",
    [
        pytest.param(None, marks=pytest.mark.slow),
        signal.SIGTERM,
        pytest.param(signal.SIGINT, marks=pytest.mark.slow),
    ],
)
def test_however_it_ends_notes_are_ended_and_files_are_whole(number, jackd, serve, tmp_path):
    jackd.start(512)
    words = ("--duration", 0.8) if number is None else ()
    server = serve(*words, *files(tmp_path), panel=True)
    osc = server.osc()
    server.said(f"playing on {DEVICE}")
    server.family()
    osc.send("/note", 69, 100)
    osc.send("/note", 72, 100)
    time.sleep(0.3)
    if number is not None:  # as Ctrl-C does, to all processes of the terminal's group
        os.killpg(server.process.pid, number)
    assert server.wait() == 0
    assert not any("gone" in line for line in server.lines)

    played = take(tmp_path / "take.wav")
    assert np.abs(played).max() > 0.02
    loudest = np.abs(played[-round(0.3 * RATE) :]).max()
    assert np.abs(played[-round(0.005 * RATE) :]).max() < 0.5 * loudest  # it was ending
    lines = [json.loads(line) for line in (tmp_path / "take.jsonl").read_text().splitlines()]
    assert lines[-1] == {"end": len(played)}
    keys = {
        kind: [line[3:5] for line in lines if isinstance(line, list) and line[2] == kind]
        for kind in ("begin", "end")
    }
    assert [key for _, key in keys["begin"]] == [69.0, 72.0]
    assert sorted(keys["end"]) == sorted(keys["begin"])
    capture = read_capture(tmp_path / "take.jsonl")
    stage = capture.beginning.ensemble()
    instrument = stage.first
    again = np.concatenate([*blocks(capture, stage)])
    assert instrument.target("/bow/speed") == instrument.target("/bow/side") == 0.0
    assert instrument._rig["player"]["held"] == 0
    np.testing.assert_array_equal(again, played)


def test_a_killed_server_leaves_no_process_and_a_capture_that_can_be_replayed(
    jackd, serve, tmp_path
):
    jackd.start(512)
    server = serve(*files(tmp_path), panel=True)
    osc = server.osc()
    server.said(f"playing on {DEVICE}")
    osc.send("/note", 69, 100)
    time.sleep(0.5)
    server.family()
    server.process.kill()
    assert server.wait() == -signal.SIGKILL
    assert np.abs(replayed(tmp_path)).max() > 0.02


# ---------------------------------------------------------------- options


def command(jackd, *words: object) -> subprocess.CompletedProcess:
    """Run a command to its end."""
    return forks.run(*words, env=jackd.environment)


def refused(jackd, folder: Path, *words: object) -> str:
    """Run a command that must be refused; return its one line. It may leave nothing behind."""
    files_before = sorted(folder.iterdir())
    run = command(jackd, "serve", "--no-http", *words)
    assert run.returncode == 2, run.stderr
    assert run.stdout == ""
    lines = [line for line in run.stderr.splitlines() if "compiling" not in line]
    assert len(lines) == 1, lines
    assert sorted(folder.iterdir()) == files_before
    assert not [port for port in jackd.ports() if port.startswith("yehu-server")]
    return lines[0]


def test_a_rate_the_named_device_does_not_have_is_refused_once_and_no_file_left(jackd, tmp_path):
    jackd.start(512, rate=RATE)
    words = ("--audio-device", "JACK", "--rate", 44100, "--osc", "127.0.0.1:0", "--no-http")
    run = command(jackd, "serve", *words, *files(tmp_path))
    assert run.returncode == 2
    *others, line = run.stderr.splitlines()
    own = "its own rate is 48000 Hz: --rate 48000"
    assert line == f"yehu-server: {DEVICE} does not run at 44100 Hz ({own})"
    assert not any("44100 Hz" in other for other in others)
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
def test_a_rate_the_default_device_does_not_have_is_said_and_played_in_silence(jackd, serve):
    jackd.start(512)
    server = serve("--rate", 44100, "--midi-api", "none", "--duration", 1.0)
    server.said("does not run at 44100 Hz", 120.0)
    osc = server.osc()
    status = osc.status()
    assert status["device"] == "silent clock"
    assert status["rate"] == 44100
    assert "44100 Hz" in status["problem"]
    assert server.wait() == 0


def test_where_the_recording_cannot_be_written_no_capture_is_left(jackd, tmp_path):
    jackd.start(512)
    refused(
        jackd, tmp_path, "--osc", "127.0.0.1:0", "--audio-device", "null",
        "--capture", tmp_path / "take.jsonl", "--record", tmp_path / "no folder" / "take.wav",
    )  # fmt: skip


def test_options_come_from_a_file_and_the_command_line_wins(jackd, serve, tmp_path):
    jackd.start(512, rate=RATE)
    config = tmp_path / "yehu.toml"
    config.write_text(
        'audio-device = "JACK"\nblocksize = 333\nchannels = 1\nmidi_api = "none"\nseed = 5\n'
        f'duration = 30\ncapture = "{tmp_path / "take.jsonl"}"\n[set]\n"/playing/attack" = 80\n'
    )
    server = serve("--config", config, "--channels", 2)
    osc = server.osc()
    server.said(f"playing on {DEVICE}")
    assert osc.status()["blocksize"] == 333
    assert osc.ask("/get", "/playing/attack")["/playing/attack"] == [80.0]
    assert "yehu-server:out_1" in jackd.ports()
    assert server.end() == 0
    header = json.loads((tmp_path / "take.jsonl").read_text().splitlines()[0])
    assert [player["seed"] for player in header["players"]] == [5]


def test_without_any_device_it_says_so_and_plays_in_silence(jackd, serve, tmp_path):
    jackd.stop()
    found = json.loads(command(jackd, "devices", "--json").stdout)
    if found["audio"]:
        pytest.skip("there is a sound card here")
    server = serve("--duration", 1.0, *files(tmp_path))
    osc = server.osc()
    server.said("there is no audio output: playing on a silent clock")
    osc.send("/note", 69, 100)
    assert osc.status()["device"] == "silent clock"
    assert server.wait() == 0
    played = take(tmp_path / "take.wav")
    assert np.abs(played).max() > 0.02
