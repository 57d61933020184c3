"""Serves the page to a browser, with an imitation of its sound, and drives it by Node."""

from __future__ import annotations

import http.server
import json
import shutil
import subprocess
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from yehu_server.ahead.build import page_linker, page_module
from yehu_server.live.page import facts
from yehu_server.live.page.site import MODULE

HERE = Path(__file__).parent
ROOT = HERE.parents[2]
WEB = ROOT / "web"
NODE, CHROMIUM = shutil.which("node"), shutil.which("chromium")
PLAYWRIGHT = ROOT / "node_modules" / "playwright-core"
LIMIT_S = 120.0


def missing() -> str | None:
    """Why no browser can be driven here; None if one can."""
    if NODE is None or CHROMIUM is None:
        return "needs node and chromium"
    if page_linker() is None:
        return "needs wasm-ld"
    return None if PLAYWRIGHT.is_dir() else "needs playwright-core: npm ci"


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


def drive(scenario: str, url: str, *words: str) -> Any:
    """Run a scenario of this folder in a browser; return what it found."""
    done = subprocess.run(
        [str(NODE), str(HERE / scenario), url, str(CHROMIUM), *words],
        capture_output=True, text=True, timeout=LIMIT_S, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)
