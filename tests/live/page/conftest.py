"""The page's folder as a browser gets it, and Node to run its modules."""

import json
import os
import shutil
import subprocess
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

import pytest
from live.page.browser import missing, running, served

from yehu_server.ahead.build import page_linker, page_module
from yehu_server.live.page import facts
from yehu_server.live.page.examples import write_capture_headers
from yehu_server.live.page.site import (
    MODULE,
    page_files,
    page_folder,
    server_of,
    url_of,
    write_page,
)


@pytest.fixture(scope="session")
def run_node() -> Callable[..., str]:
    """Run Node with words, and lines of JSON as its input, in this folder; what it prints."""
    if (node := shutil.which("node")) is None:
        pytest.skip("there is no Node here")

    def run(*words: object, lines: Iterable[object] = (), **environment: str) -> str:
        done = subprocess.run(
            [node, *map(str, words)],
            input="\n".join(map(json.dumps, lines)),
            env=os.environ | environment,
            cwd=Path(__file__).parent,
            capture_output=True,
            text=True,
            timeout=300,
            check=False,
        )
        assert done.returncode == 0, done.stdout[-3000:] + done.stderr
        return done.stdout

    return run


@pytest.fixture(scope="session")
def page(tmp_path_factory) -> Path:
    """A folder with the page's modules, and what is generated for them, but for WebAssembly."""
    folder = tmp_path_factory.mktemp("web")
    for file in page_files():
        (folder / file).parent.mkdir(exist_ok=True)
        shutil.copy(page_folder() / file, folder / file)
    (folder / "package.json").write_text('{"type": "module"}')
    facts.write(folder)
    return folder


@pytest.fixture(scope="session")
def playing(page) -> Path:
    """That folder, with the interpreter and the instrument in WebAssembly."""
    if page_linker() is None:
        pytest.skip("there is no wasm-ld")
    shutil.copy(page_module(), page / MODULE)
    return page


@pytest.fixture(scope="session")
def imitated(tmp_path_factory) -> Iterator[str]:
    """The address of the page, with an imitation of its sound."""
    if missing():
        pytest.skip(str(missing()))
    generated = tmp_path_factory.mktemp("generated")
    write_capture_headers(generated / "captures")
    with served(generated) as url:
        yield url


@pytest.fixture(scope="session")
def written(tmp_path_factory) -> Path:
    """The folder of the page, written as static files with all that sounds."""
    if missing():
        pytest.skip(str(missing()))
    folder = tmp_path_factory.mktemp("page")
    write_page(folder)
    return folder


@pytest.fixture(scope="session")
def sounding(written) -> Iterator[str]:
    """The address of that page."""
    with running(server := server_of(written, 0)):
        yield url_of(server)
