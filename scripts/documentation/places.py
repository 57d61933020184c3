"""Where each file of the repository stands on the site.

Pages of ``docs/`` keep their places. Those that stand elsewhere, such as the README and
``mappings/README.md``, get one, so that links between pages lead to pages. Of other files a page
links to, texts of code become pages, and the rest is copied.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from pathlib import Path, PurePosixPath
from urllib.parse import unquote, urlsplit

ROOT = Path(__file__).resolve().parents[2]
DOCS = "docs/"
PARTS = "docs/site/"  # what only the site has: its home, the pages of the API, looks

NOTEBOOKS, NOTEBOOK = "examples/notebooks/", ".ipynb"  # shown as pages

# Pages by their paths in the repository, and what MkDocs is to take them for.
ELSEWHERE = {
    "README.md": "begin.md",
    "CHANGELOG.md": "changes.md",
    "CONTRIBUTING.md": "contributing.md",
    "SECURITY.md": "security.md",
    "docs/README.md": "pages.md",
    "docs/site/home.md": "index.md",
    "mappings/README.md": "mappings.md",
    "presets/README.md": "presets.md",
    "tunings/README.md": "tunings.md",
}
# The folder of the site that has the page of the instrument; links to its source lead there.
PLAY = "play"
INSTRUMENT = "web/index.html"
LANGUAGES = {".c": "c", ".js": "js", ".mjs": "js", ".py": "python", ".sh": "bash", ".toml": "toml"}

_FENCED = re.compile(r"^```.*?^```$", re.MULTILINE | re.DOTALL)
_LINK = re.compile(r"\]\(([^)\s]+)\)")


def pages() -> dict[str, str]:
    """Every page of the site, by its path in the repository: its place among MkDocs's sources."""
    found = dict(ELSEWHERE)
    for path in sorted((ROOT / DOCS).rglob("*.md")):
        name = path.relative_to(ROOT).as_posix()
        found.setdefault(name, name.removeprefix(PARTS).removeprefix(DOCS))
    for path in sorted((ROOT / NOTEBOOKS).glob(f"*{NOTEBOOK}")):
        name = path.relative_to(ROOT).as_posix()
        found[name] = place(name)
    return found


def target(link: str, page: str) -> tuple[str, str] | None:
    """Return what a link leads to: a path in the repository, and the fragment in it.

    Parameters
    ----------
    link : str
        As it stands in the page, such as ``../presets/README.md#files``.
    page : str
        The path of the page in the repository.

    Returns
    -------
    tuple of str or None
        None for links within the page and to other sites. ``/`` is the root of the repository.
    """
    address = urlsplit(link)
    if address.scheme or address.netloc or not address.path:
        return None
    folder = PurePosixPath("/", page).parent
    path = os.path.normpath(str(folder / unquote(address.path))).lstrip("/")
    if (ROOT / path).is_dir() and (ROOT / path / "README.md").exists():
        path = f"{path}/README.md"
    return PurePosixPath(path).as_posix(), address.fragment


def title(path: str) -> str | None:
    """Return the title of a page by its path in the repository; None if it is no page."""
    if not path.endswith(".md") or not (ROOT / path).is_file():
        return None
    found = re.search(r"^# +(.+?) *$", (ROOT / path).read_text(encoding="utf-8"), re.MULTILINE)
    return None if found is None else found[1].replace("`", "")


def place(path: str) -> str:
    """Return where a file of the repository stands among MkDocs's sources."""
    if path in ELSEWHERE:
        return ELSEWHERE[path]
    if path == INSTRUMENT:
        return f"{PLAY}/index.html"
    if path.startswith(NOTEBOOKS) and path.endswith(NOTEBOOK):
        return f"notebooks/{PurePosixPath(path).stem}.md"
    if path.startswith(DOCS):
        return path.removeprefix(PARTS if path.endswith(".md") else DOCS).removeprefix(DOCS)
    return f"source/{path}.md" if PurePosixPath(path).suffix in LANGUAGES else f"files/{path}"


def linked_files() -> Iterator[str]:
    """The files outside of ``docs/`` that pages link to, and that are no pages."""
    all_pages = pages()
    known = {*all_pages, INSTRUMENT}
    found = set()
    for page in all_pages:
        text = _FENCED.sub("", (ROOT / page).read_text(encoding="utf-8"))
        for link in _LINK.findall(text):
            aim = target(link, page)
            if aim and aim[0] not in known and not aim[0].startswith(DOCS):
                found.add(aim[0])
    yield from sorted(path for path in found if (ROOT / path).is_file())


def page_of_code(path: str) -> str:
    """Return the page that shows a file of code, as Markdown."""
    code = (ROOT / path).read_text(encoding="utf-8")
    hidden = "---\nsearch:\n  exclude: true\n---\n"
    return f"{hidden}\n# `{path}`\n\n{fenced(code, LANGUAGES[PurePosixPath(path).suffix])}\n"


def fenced(code: str, language: str) -> str:
    """Return a block of code, as Markdown."""
    fence = "`" * (3 + max(map(len, re.findall("`+", code)), default=0))
    return f"{fence}{language}\n{code.rstrip()}\n{fence}"
