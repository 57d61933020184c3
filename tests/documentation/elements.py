"""The elements of a page of HTML, and what they stand in."""

from __future__ import annotations

from html.parser import HTMLParser
from pathlib import Path

VOID = {"area", "br", "col", "hr", "img", "input", "link", "meta", "source", "wbr"}


class Elements(HTMLParser):
    """The elements of a page: tag, attributes, and the tags and classes that they stand in."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.found: list[tuple[str, dict[str, str | None], list[str]]] = []
        self.words: list[tuple[str, list[str]]] = []
        self._open: list[tuple[str, str]] = []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        attributes = dict(attrs)
        around = [word for name, classes in self._open for word in (name, *classes.split())]
        self.found.append((tag, attributes, around))
        if tag not in VOID:
            self._open.append((tag, attributes.get("class") or ""))

    def handle_endtag(self, tag):
        if tag in [name for name, _ in self._open]:
            while self._open.pop()[0] != tag:
                pass

    def handle_data(self, data):
        self.words.append((data, [name for name, _ in self._open]))

    def text_in(self, tag: str) -> str:
        return " ".join("".join(data for data, around in self.words if tag in around).split())


def elements(site: Path, name: str) -> Elements:
    return Elements((site / name).read_text(encoding="utf-8"))
