"""Serves the page to a browser, with an imitation of its sound, and plays scenarios in it."""

import atexit
import http.server
import json
import shutil
import subprocess
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Any

import pytest

from yehu_server.ahead.build import page_linker, page_module
from yehu_server.live.page import facts
from yehu_server.live.page.site import MODULE

HERE = Path(__file__).parent
ROOT = HERE.parents[2]
WEB = ROOT / "web"
NODE, CHROMIUM = shutil.which("node"), shutil.which("chromium")
# Chromium without its own interface, which is a page as well: it opens a page with half the work.
SHELL = shutil.which("chromium-headless-shell") or CHROMIUM
PLAYWRIGHT = WEB / "node_modules" / "playwright-core"
LIMIT_S = 300.0  # on a busy machine


def missing() -> str | None:
    """Why no browser can be driven here; None if one can."""
    if NODE is None or CHROMIUM is None:
        return "needs node and chromium"
    if page_linker() is None:
        return "needs wasm-ld"
    return None if PLAYWRIGHT.is_dir() else "needs playwright-core: npm ci in web/"


in_browser = pytest.mark.skipif(missing() is not None, reason=str(missing()))


class _Handler(http.server.SimpleHTTPRequestHandler):
    """Serves `web/`, the generated files from where they were written, and the imitation."""

    replaced: dict[str, Path]

    def translate_path(self, path: str) -> str:
        plain = path.partition("?")[0]
        return str(self.replaced[plain]) if plain in self.replaced else super().translate_path(path)

    def end_headers(self) -> None:
        self.send_header("Cache-Control", "no-store")
        super().end_headers()

    def log_message(self, *_: Any) -> None:
        """Say nothing."""


@contextmanager
def running(server: http.server.ThreadingHTTPServer) -> Iterator[None]:
    """A server at its work on a thread; it ends, whatever happens."""
    thread = threading.Thread(target=server.serve_forever, daemon=True)
    with server:
        thread.start()
        try:
            yield
        finally:
            server.shutdown()
            thread.join()


@contextmanager
def served(generated: Path) -> Iterator[str]:
    """Serve the page on a free port of this machine.

    Parameters
    ----------
    generated : Path
        The folder to write ``facts.js``, ``examples.js`` and the WebAssembly module into; it may
        have ``captures/``.
    """
    facts.write(generated)
    shutil.copy(page_module(), generated / MODULE)
    replaced = {"/sound/sound.js": HERE / "imitation.js"}
    for file in generated.rglob("*.*"):
        replaced[f"/{file.relative_to(generated)}"] = file
    handler = type("Handler", (_Handler,), {"replaced": replaced})
    server = http.server.ThreadingHTTPServer(
        ("127.0.0.1", 0), lambda *args: handler(*args, directory=str(WEB))
    )
    with running(server):
        yield f"http://127.0.0.1:{server.server_address[1]}/"


class Driver:
    """Node with a browser, which plays one scenario after another; begun when it is needed."""

    def __init__(self) -> None:
        self._process: subprocess.Popen[str] | None = None

    def _lines(self) -> tuple[IO[str], IO[str]]:
        if self._process is None or self._process.poll() is not None:
            self._process = subprocess.Popen(
                [str(NODE), str(HERE / "driver.mjs"), str(SHELL), str(CHROMIUM)],
                stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
            )  # fmt: skip
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        return self._process.stdin, self._process.stdout

    def _stop(self) -> None:
        if self._process is not None:
            self._process.kill()

    def close(self) -> None:
        """End it, with its browser, by the end of its input."""
        if self._process is not None:
            self._process.communicate()
            self._process = None

    def play(
        self, scenario: str, url: str, *words: str, reach: Callable[[str], Any] | None = None
    ) -> Any:
        """Play a scenario; do something at each step that it reaches; return what it found.

        Whatever the browser's console reported as an error or a warning fails it.
        """
        requests, answers = self._lines()
        limit = threading.Timer(LIMIT_S, self._stop)
        limit.start()
        try:
            asked = {"scenario": str(HERE / scenario), "url": url, "words": words}
            print(json.dumps(asked), file=requests, flush=True)
            for line in answers:
                answer = json.loads(line)
                if "step" not in answer:
                    break
                if reach is not None:
                    reach(answer["step"])
                print("go", file=requests, flush=True)
            else:
                pytest.fail(f"{scenario} did not end within {LIMIT_S:.0f} s, or Node broke off")
        except BaseException:  # what is left of the scenario would answer to the next one
            self._stop()
            self.close()
            raise
        finally:
            limit.cancel()
        assert "found" in answer, answer["failed"]
        found = answer["found"]
        assert not isinstance(found, dict) or not found.get("errors"), found["errors"]
        return found


_driver = Driver()
atexit.register(_driver.close)
drive = _driver.play
