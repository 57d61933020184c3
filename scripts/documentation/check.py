"""Checks a built site: links lead somewhere, and nothing is loaded from elsewhere.

    .venv/bin/python scripts/documentation/check.py FOLDER

Prints a line for each fault, and ends with 1 if there is one.
"""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Iterator
from dataclasses import dataclass, field
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urljoin, urlsplit

# Elements of which a browser loads something by itself, and the attribute that says what.
LOADS = {
    ("audio", "src"), ("embed", "src"), ("iframe", "src"), ("img", "src"), ("img", "srcset"),
    ("input", "src"), ("link", "href"), ("object", "data"), ("script", "src"), ("source", "src"),
    ("track", "src"), ("video", "poster"), ("video", "src"),
}  # fmt: skip
GOES = {("a", "href"), ("area", "href"), ("form", "action")}
_CSS_URL = re.compile(r"(?:url\(\s*|@import\s+)[\"']?([^\"')\s]+)")
_COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)


@dataclass
class Reading:
    """What a page has: the ids in it, what it loads and what it leads to."""

    ids: set[str] = field(default_factory=set)
    loads: list[str] = field(default_factory=list)
    goes: list[str] = field(default_factory=list)


class _Reader(HTMLParser):
    def __init__(self) -> None:
        super().__init__()
        self.reading = Reading()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        for name, value in attrs:
            if value is None:
                continue
            if name == "id" or (tag, name) == ("a", "name"):
                self.reading.ids.add(value)
            elif (tag, name) in LOADS:
                self.reading.loads.append(value)
            elif (tag, name) in GOES:
                self.reading.goes.append(value)
            elif name == "style":
                self.reading.loads += _CSS_URL.findall(value)


def read(page: Path) -> Reading:
    """Read a page of HTML."""
    reader = _Reader()
    reader.feed(page.read_text(encoding="utf-8"))
    reader.close()
    return reader.reading


def faults(site: Path) -> Iterator[str]:
    """Yield what is wrong with a built site, a line each.

    Parameters
    ----------
    site : Path
        The folder of the site.
    """
    read_pages = {page: read(page) for page in sorted(site.rglob("*.html"))}
    if not read_pages:
        yield f"{site}: no page is there"
    for page, reading in read_pages.items():
        name = page.relative_to(site).as_posix()
        for link in reading.loads:
            if _is_elsewhere(link):
                yield f"{name}: loads {link} from elsewhere"
        for link in (*reading.loads, *reading.goes):
            if (fault := _fault(site, name, link, read_pages)) is not None:
                yield f"{name}: {link}: {fault}"
    for style in sorted(site.rglob("*.css")):
        name = style.relative_to(site).as_posix()
        for link in _CSS_URL.findall(_COMMENT.sub("", style.read_text(encoding="utf-8"))):
            if _is_elsewhere(link):
                yield f"{name}: loads {link} from elsewhere"
            elif (fault := _fault(site, name, link, read_pages)) is not None:
                yield f"{name}: {link}: {fault}"


def _is_elsewhere(link: str) -> bool:
    address = urlsplit(link)
    return bool(address.netloc) or address.scheme not in {"", "data"}


def _fault(site: Path, name: str, link: str, pages: dict[Path, Reading]) -> str | None:
    """What is wrong with a link from a file of the site; None if nothing is."""
    address = urlsplit(link)
    if address.scheme or address.netloc:
        return None
    if not address.path and not address.query and not address.fragment:
        return None  # to the page itself
    path = unquote(urlsplit(urljoin(f"/{name}", address.path or f"/{name}")).path)
    target = site / path.lstrip("/")
    if target.is_dir():
        target /= "index.html"
    if not target.is_file():
        return "no such file"
    fragment = unquote(address.fragment)
    if fragment and target in pages and fragment not in pages[target].ids:
        return "no such place in the page"
    return None


def main() -> int:
    """Check the folder of the command line."""
    parser = argparse.ArgumentParser(description="Check a built site.")
    parser.add_argument("folder", type=Path)
    found = list(faults(parser.parse_args().folder))
    print(*found, sep="\n", end="\n" if found else "")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
