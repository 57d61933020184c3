"""The page's files: written as a folder, or served, from memory or for a try."""

import base64
import gzip
import hashlib
import html
import json
import logging
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

from aiohttp import web

from yehu_server.ahead.build import SHIPPED, page_module, shipped_version
from yehu_server.core.player.note_range import YEHU, NoteRange
from yehu_server.errors import OutputError, YehuError
from yehu_server.live.network import listening, why_not
from yehu_server.live.page.examples import examples, write_capture_headers
from yehu_server.live.page.facts import facts, module, write
from yehu_server.util.files import error_reason, make_folder, shipped_folder, write_bytes

INDEX = "index.html"
# This meta element says that a yehu server serves the page; the static page does not have it.
HEAD = '<meta charset="utf-8">'
MARK = (HEAD, f'{HEAD}\n<meta name="yehu-server" content="1">')
# And this one, that its service worker, which knows all of its files, may keep the page.
WORKER = "sw.js"
KEPT = (HEAD, f'{HEAD}\n<meta name="yehu-worker" content="{WORKER}">')
TYPES = {
    ".css": "text/css; charset=utf-8",
    ".html": "text/html; charset=utf-8",
    ".json": "application/json",
    ".js": "text/javascript; charset=utf-8",
    ".png": "image/png",
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
class CachedFile:
    """A file: its bytes, as they are and compressed, and a tag that changes with them."""

    content_type: str
    plain: bytes
    compressed: bytes | None
    tag: str


class Site:
    """The files of the page, by their names in the address, for an instrument with some notes."""

    def __init__(self, notes: NoteRange = YEHU) -> None:
        self._files: dict[str, CachedFile] = {}
        self._no_module_reason: str | None = None
        folder = page_folder()
        for name in map(Path.as_posix, page_files()):
            self._store(name, (folder / name).read_bytes())
        index = (folder / INDEX).read_text("utf-8").replace(*MARK, 1)
        self._store(INDEX, index.encode())
        self._store(FACTS, module(facts(notes)).encode())
        self._store("examples.js", module(examples()).encode())

    def add_module(self, data: bytes) -> None:
        """Add the instrument in WebAssembly, once it is there."""
        self._store(MODULE, data)

    def set_no_module(self, reason: str) -> None:
        """Answer with a reason that there is none, and that there won't be one."""
        self._no_module_reason = reason

    def add_capture_header(self, name: str, text: str) -> None:
        """Add a file that captures of pages begin with."""
        self._store(f"{CAPTURES}/{name}", text.encode())

    def answer(self, request: web.Request) -> web.Response:
        """Answer with the file of a request's path."""
        cached = self._files.get(request.path.removeprefix("/") or INDEX)
        if cached is None and request.path == f"/{MODULE}":
            if self._no_module_reason is not None:
                raise web.HTTPNotFound(text=f"{self._no_module_reason}\n")
            raise web.HTTPServiceUnavailable(headers={"Retry-After": "1"}, text="not built yet\n")
        if cached is None:
            raise web.HTTPNotFound(text="nothing here\n")
        headers = HEADERS | {"ETag": cached.tag, "Vary": "Accept-Encoding"}
        if cached.tag in request.headers.get("If-None-Match", ""):
            return web.Response(status=304, headers=headers)
        headers["Content-Type"] = cached.content_type
        if cached.compressed is not None and "gzip" in request.headers.get("Accept-Encoding", ""):
            headers["Content-Encoding"] = "gzip"
            return web.Response(body=cached.compressed, headers=headers)
        return web.Response(body=cached.plain, headers=headers)

    def _store(self, name: str, data: bytes) -> None:
        small = gzip.compress(data, mtime=0)
        self._files[name] = CachedFile(
            TYPES[Path(name).suffix],
            data,
            small if len(small) < WORTH_IT * len(data) else None,
            f'"{hashlib.sha256(data).hexdigest()[:32]}"',
        )


log = logging.getLogger(__name__)

MODULE, CAPTURES = "yehu.wasm", "captures"
SERVED = {".css", ".html", ".js", ".png", ".svg", ".webmanifest"}
FACTS, TEXTS = "facts.js", "texts"
CHECKERS = "node_modules"  # of a checkout
GENERATED = {FACTS, "examples.js"}


def page_files() -> Iterator[Path]:
    """The files of the page that are written by hand, relative to `page_folder`."""
    for file in _files_of(page_folder()):
        is_served = file.suffix in SERVED or file.parent.name == TEXTS
        if is_served and file.name not in GENERATED and file.parts[0] != CHECKERS:
            yield file


def page_folder() -> Path:
    """The folder of the page."""
    return shipped_folder("web")


def write_page(folder: Path, share_url: str = "") -> list[Path]:
    """Write the whole page into a folder; return its files, relative to the folder.

    `share_url`: the address of the same page for everybody, which its links name.

    Where its module cannot be built, it is the page that was shipped, as it was then: parameters
    and snapshots may lie elsewhere in a module of other sources. Raises OutputError where one
    cannot be written; YehuError where there is no WebAssembly module, and nothing to build it with.
    """
    try:
        module = page_module()
    except YehuError as error:
        if not (version := shipped_version()):
            raise
        log.warning("the page is that of version %s: %s", version, error)
        return _copy_all(_files_of(SHIPPED.parent), SHIPPED.parent, folder)
    written = _copy_all(page_files(), page_folder(), folder)
    try:
        write_bytes(folder / MODULE, module.read_bytes())
        write(folder)
        beginnings = write_capture_headers(folder / CAPTURES)
        index = (folder / INDEX).read_text("utf-8").replace(*KEPT, 1)
        if share_url:
            meta = f'<meta name="yehu-share" content="{html.escape(share_url)}">'
            index = index.replace(HEAD, f"{HEAD}\n{meta}", 1)
        (folder / INDEX).write_text(index, "utf-8")
        files = [*written, *map(Path, sorted(GENERATED)), Path(MODULE)]
        files += [path.relative_to(folder) for path in beginnings]
        _write_worker(folder, [file for file in files if file != Path(WORKER)])
    except OSError as error:
        raise OutputError(f"{folder}: {error_reason(error)}") from error
    return files


def _write_worker(folder: Path, files: list[Path]) -> None:
    """Write into the service worker which files it keeps, and a version that changes with them."""
    data = {file.as_posix(): (folder / file).read_bytes() for file in files}
    version = hashlib.sha256(b"".join(data.values()))
    names = json.dumps([(name, _integrity(of)) for name, of in {"./": data[INDEX], **data}.items()])
    text = (folder / WORKER).read_text("utf-8")
    text = text.replace('VERSION = ""', f'VERSION = "{version.hexdigest()[:16]}"')
    (folder / WORKER).write_text(text.replace("FILES = []", f"FILES = {names}"), "utf-8")


def _integrity(data: bytes) -> str:
    """What a browser checks a file by (Subresource Integrity)."""
    return f"sha256-{base64.b64encode(hashlib.sha256(data).digest()).decode()}"


def _files_of(folder: Path) -> Iterator[Path]:
    """All files of a folder, relative to it."""
    for path in sorted(folder.rglob("*")):
        if path.is_file():
            yield path.relative_to(folder)


def _copy_all(files: Iterable[Path], source: Path, folder: Path) -> list[Path]:
    """Copy files into another folder; return them. Raises OutputError."""
    copied = list(files)
    for file in copied:
        make_folder((folder / file).parent)
        write_bytes(folder / file, (source / file).read_bytes())
    return copied


HOST = "127.0.0.1"
CACHING = "no-cache"  # another version may be written into the folder


class _Handler(SimpleHTTPRequestHandler):
    extensions_map = SimpleHTTPRequestHandler.extensions_map | TYPES

    def end_headers(self) -> None:
        self.send_header("Cache-Control", CACHING)
        super().end_headers()

    def log_message(self, *_: Any) -> None:
        """Log nothing: whoever serves the page to himself sees it."""


def server_of(folder: Path, port: int) -> ThreadingHTTPServer:
    """A server of a folder's files on a port (0: any free), not yet running; or OutputError."""
    try:
        listener = listening((HOST, port))
    except OSError as error:
        raise OutputError(f"{HOST}:{port}: {why_not(error)}") from error
    handler = partial(_Handler, directory=str(folder))
    server = ThreadingHTTPServer(listener.getsockname(), handler, bind_and_activate=False)
    server.socket.close()
    server.socket = listener
    return server


def url_of(server: ThreadingHTTPServer) -> str:
    """The address of the page."""
    return f"http://{HOST}:{server.server_address[1]}/"
