"""Try a wheel as a stranger would: in fresh environments, without a compiler, git or a cache.

    python trials.py WHEEL [PYTHON...]

It needs nothing but the standard library, and runs on Linux, macOS and Windows. For each Python:
`pip install`, a render, `serve` with the clock that needs no sound card, an import from another
folder, and the page, written (heard in Chromium where playwright-core is installed in web/).
"""

import contextlib
import functools
import http.server
import os
import shutil
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
VERSIONS = ("3.11", "3.12", "3.13", "3.14")
IS_WINDOWS = sys.platform == "win32"
END: int = getattr(signal, "CTRL_BREAK_EVENT", signal.SIGTERM)  # what a terminal sends, on Windows
OWN_GROUP: int = getattr(subprocess, "CREATE_NEW_PROCESS_GROUP", 0)
RENDER_S = 3.0  # what a first render of a phrase should take at most on a quiet machine
STARTED_S, NOTE_S, ENDED_S = 60.0, 1.0, 20.0


class TrialError(Exception):
    """What did not work."""


def pythons() -> dict[str, str | None]:
    """A Python of each version that is here, by its path; None where there is none."""
    found: dict[str, str | None] = {}
    for version in VERSIONS:
        places = [f"python{version}", *map(str, sorted(_pyenv().glob(f"{version}.*/bin/python")))]
        found[version] = next(filter(None, map(_usable(version), places)), None)
    return found


def _pyenv() -> Path:
    return Path(os.environ.get("PYENV_ROOT", Path.home() / ".pyenv")) / "versions"


def _usable(version: str) -> Callable[[str], str | None]:
    def path_of(program: str) -> str | None:
        code = "import sys, venv, ensurepip; print('%d.%d' % sys.version_info[:2], sys.executable)"
        with contextlib.suppress(OSError):
            done = subprocess.run(  # noqa: S603 - our own
                [program, "-c", code], capture_output=True, text=True, check=False
            )
            of, _, path = done.stdout.strip().partition(" ")
            if of == version:
                return path
        return None

    return path_of


class Installation:
    """The wheel in an environment of its own, with a home that is empty."""

    def __init__(self, python: str, wheel: Path, folder: Path) -> None:
        self.folder = folder
        programs = folder / "env" / ("Scripts" if IS_WINDOWS else "bin")
        self.python, self.command = programs / "python", programs / "yehu-server"
        home = folder / "home"
        home.mkdir(parents=True)
        # No compiler and no git; pip alone has its user's settings, for its indexes.
        self.environment = {**os.environ, "PATH": str(programs)}
        self.run(python, "-m", "venv", str(folder / "env"))
        began = time.monotonic()
        options = ("--quiet", "--disable-pip-version-check", "--only-binary=:all:")
        self.run(self.python, "-m", "pip", "install", *options, str(wheel))
        self.installed_s = time.monotonic() - began
        kept = {
            name: os.environ[name] for name in ("SYSTEMROOT", "TEMP", "LANG") if name in os.environ
        }
        # And from here on the settings and caches of nobody.
        self.environment = {
            **kept,
            "PATH": str(programs),
            "HOME": str(home),
            "USERPROFILE": str(home),
        }

    def run(self, *words: str | Path) -> str:
        """Run a command in the environment and return what it printed; raises TrialError."""
        done = subprocess.run(  # noqa: S603 - our own
            [*map(str, words)],
            env=self.environment,
            cwd=self.folder,
            capture_output=True,
            text=True,
            check=False,
        )
        if done.returncode:
            raise TrialError(f"{Path(words[0]).name}: {done.stderr.strip()[-600:]}")
        return done.stdout


def render(there: Installation) -> str:
    """The first render, with an empty cache."""
    began, before = time.monotonic(), os.times()
    there.run(there.command, "render", score_of(there), "-o", "first.wav")
    took, after = time.monotonic() - began, os.times()
    # Of the processors, which tells more beside other work; Windows does not say.
    computed = sum(after[2:4]) - sum(before[2:4])
    _heard(there.folder / "first.wav")
    late = "" if took <= RENDER_S else f", more than {RENDER_S:g}"
    return f"{took:.1f} s, {computed:.1f} s of processor time{late}"


def score_of(there: Installation) -> str:
    """A phrase, written."""
    path = there.folder / "phrase.abc"
    path.write_text("X:1\nT:A phrase\nM:4/4\nL:1/4\nQ:1/4=120\nK:G\nG A B d |]\n", "utf-8")
    return str(path)


def _heard(sound: Path) -> None:
    """Raise TrialError where a WAV file, of whatever samples, is silent."""
    _, _, samples = sound.read_bytes().partition(b"data")
    if not any(samples[4:]):  # behind their length
        raise TrialError(f"{sound.name} is silent")


def serve(there: Installation) -> str:
    """A note by OSC, on the silent clock, recorded; and the end at a signal."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as finder:
        finder.bind(("127.0.0.1", 0))
        port = finder.getsockname()[1]
    words = ("--audio-device", "null", "--no-http", "--osc", f"127.0.0.1:{port}")
    command = [str(there.command), "serve", *words, "--record", "served.wav"]
    began = time.monotonic()
    server = subprocess.Popen(  # noqa: S603 - our own
        command,
        env=there.environment,
        cwd=there.folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        creationflags=OWN_GROUP,
    )
    try:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as osc:
            osc.connect(("127.0.0.1", port))
            osc.settimeout(0.2)
            started = _answered(osc, server, began)
            osc.send(_message("/yehu/note", 69.0, 90.0))
            time.sleep(NOTE_S)
        server.send_signal(END)
        said = server.communicate(timeout=ENDED_S)[0]
    finally:
        server.kill()
        server.wait()
    if server.returncode:
        raise TrialError(f"serve ended with {server.returncode}: {said.strip()[-600:]}")
    _heard(there.folder / "served.wav")
    midi = next((line for line in said.splitlines() if "MIDI: none" in line), "MIDI")
    return f"plays {started:.1f} s after its start ({midi.strip()[:80]})"


def _answered(osc: socket.socket, server: subprocess.Popen[str], began: float) -> float:
    while time.monotonic() - began < STARTED_S:
        if server.poll() is not None:
            raise TrialError(f"serve ended: {server.communicate()[0].strip()[-600:]}")
        with contextlib.suppress(OSError):
            osc.send(_message("/yehu/status"))
            if osc.recv(65536):
                return time.monotonic() - began
        time.sleep(0.1)
    raise TrialError(f"serve does not answer within {STARTED_S:g} s")


def _message(address: str, *values: float) -> bytes:
    """An OSC message with floats."""

    def padded(text: str) -> bytes:
        data = text.encode()
        return data + b"\0" * (4 - len(data) % 4)

    return (
        padded(address) + padded("," + "f" * len(values)) + struct.pack(f">{len(values)}f", *values)
    )


def api(there: Installation) -> str:
    """An import from a folder that is not ours, and a phrase by it."""
    there.run(
        there.python,
        "-c",
        "import yehu_server as y; assert abs(y.render([('G4', 0.0, 0.5)]).sound).max() > 0.01",
    )
    return "imports and renders"


def page(there: Installation) -> str:
    """The page as the wheel brings it, written; and heard, where a browser can be driven."""
    there.run(there.command, "page", "-o", "page")
    node, browser = shutil.which("node"), shutil.which("chromium") or shutil.which("chrome")
    if not (node and browser and (ROOT / "web" / "node_modules" / "playwright-core").is_dir()):
        return "written, not heard: needs node, chromium and playwright-core"
    with _served(there.folder / "page") as url:
        script = Path(__file__).with_name("page_sounds.mjs")
        done = subprocess.run(  # noqa: S603 - our own
            [node, str(script), url, browser], capture_output=True, text=True, check=False
        )
    if done.returncode:
        raise TrialError(f"page: {done.stderr.strip()[-600:]}")
    return f"sounds in Chromium after {done.stdout.strip()} ms"


class _Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_words: object) -> None:
        pass


@contextlib.contextmanager
def _served(folder: Path) -> Iterator[str]:
    handler = functools.partial(_Quiet, directory=str(folder))
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_port}/"
        server.shutdown()


TRIALS = (render, serve, api, page)


def try_wheel(wheel: Path, version: str, python: str | None) -> Iterator[tuple[str, str]]:
    """Yield what each trial of a wheel under one Python found; what failed begins with FAILED."""
    if python is None:
        yield "installs", f"not tried: there is no Python {version} here"
        return
    with tempfile.TemporaryDirectory(prefix="yehu trial ") as scratch:
        try:
            there = Installation(python, wheel.resolve(), Path(scratch))
        except (TrialError, OSError) as error:
            yield "installs", f"FAILED: {error}"
            return
        yield "installs", f"{there.installed_s:.0f} s"
        for trial in TRIALS:
            try:
                found = trial(there)
            except (TrialError, subprocess.TimeoutExpired, OSError) as error:
                found = f"FAILED: {error}"
            yield trial.__name__, found


def main(words: Sequence[str]) -> int:
    """Try a wheel under the named Pythons, or all that are here; return the exit code."""
    wheel, *named = words
    chosen = {each: shutil.which(each) for each in named} or pythons()
    failed = False
    for version, python in chosen.items():
        for what, found in try_wheel(Path(wheel), version, python):
            print(f"Python {version}: {what}: {found}", flush=True)
            failed |= found.startswith("FAILED")
    return int(failed)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
