"""The page's files as the connected server gives them: in memory, compressed where it pays."""

from __future__ import annotations

import gzip
import hashlib
from dataclasses import dataclass
from pathlib import Path

from aiohttp import web

from yehu_server.panel.examples import examples
from yehu_server.panel.facts import facts, module
from yehu_server.panel.files import CAPTURES, FACTS, MODULE, page_files, page_folder

INDEX = "index.html"
# By this the page knows that a server stands behind it: no file of its own tells.
MARK = ('<meta charset="utf-8">', '<meta charset="utf-8">\n<meta name="yehu-server" content="1">')
TYPES = {
    ".css": "text/css; charset=utf-8",
    ".html": "text/html; charset=utf-8",
    ".json": "application/json",
    ".js": "text/javascript; charset=utf-8",
    ".svg": "image/svg+xml",
    ".wasm": "application/wasm",
    ".webmanifest": "application/manifest+json",
}
WORTH_IT = 0.9  # of the size, after compressing
POLICY = (
    "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; img-src 'self'; "
    "connect-src 'self'; worker-src 'self'; manifest-src 'self'; base-uri 'none'; "
    "form-action 'none'; frame-ancestors 'none'"
)
HEADERS = {
    "Content-Security-Policy": POLICY,
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cache-Control": "no-cache",  # it is asked each time whether it has changed
}


@dataclass(frozen=True)
class Kept:
    """A file: its bytes, as they are and compressed, and what tells whether it has changed."""

    content_type: str
    plain: bytes
    compressed: bytes | None
    tag: str


class Site:
    """The files of the page, by their names in the address."""

    def __init__(self) -> None:
        self._files: dict[str, Kept] = {}
        self._lacks: str | None = None
        folder = page_folder()
        for name in map(Path.as_posix, page_files()):
            self._keep(name, (folder / name).read_bytes())
        index = (folder / INDEX).read_text("utf-8").replace(*MARK, 1)
        self._keep(INDEX, index.encode())
        self._keep(FACTS, module(facts()).encode())
        self._keep("examples.js", module(examples()).encode())

    def add_module(self, data: bytes) -> None:
        """Add the instrument in WebAssembly, once it is there."""
        self._keep(MODULE, data)

    def lack_module(self, reason: str) -> None:
        """Answer with a reason that there is none, and that there won't be one."""
        self._lacks = reason

    def add_beginning(self, name: str, text: str) -> None:
        """Add a file that captures of pages begin with."""
        self._keep(f"{CAPTURES}/{name}", text.encode())

    def answer(self, request: web.Request) -> web.Response:
        """Answer with the file of a request's path."""
        kept = self._files.get(request.path.removeprefix("/") or INDEX)
        if kept is None and request.path == f"/{MODULE}":
            if self._lacks is not None:
                raise web.HTTPNotFound(text=f"{self._lacks}\n")
            raise web.HTTPServiceUnavailable(headers={"Retry-After": "1"}, text="not built yet\n")
        if kept is None:
            raise web.HTTPNotFound(text="nothing here\n")
        headers = HEADERS | {"ETag": kept.tag, "Vary": "Accept-Encoding"}
        if kept.tag in request.headers.get("If-None-Match", ""):
            return web.Response(status=304, headers=headers)
        headers["Content-Type"] = kept.content_type
        if kept.compressed is not None and "gzip" in request.headers.get("Accept-Encoding", ""):
            headers["Content-Encoding"] = "gzip"
            return web.Response(body=kept.compressed, headers=headers)
        return web.Response(body=kept.plain, headers=headers)

    def _keep(self, name: str, data: bytes) -> None:
        small = gzip.compress(data, mtime=0)
        self._files[name] = Kept(
            TYPES[Path(name).suffix],
            data,
            small if len(small) < WORTH_IT * len(data) else None,
            f'"{hashlib.sha256(data).hexdigest()[:32]}"',
        )
