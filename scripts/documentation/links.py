"""Mends links of pages, which are right in the repository, for the site; adds players of sounds.

A link whose words are the name of a page's file gets the page's title instead.
"""

from __future__ import annotations

import re
from urllib.parse import urlsplit
from xml.etree.ElementTree import Element

from markdown import Markdown
from markdown.extensions import Extension
from markdown.treeprocessors import Treeprocessor
from mkdocs.structure.files import File, Files
from mkdocs.utils import get_relative_url
from places import place, target, title

SOUNDS = (".flac", ".wav", ".ogg")
BLOCKS = {"p", "table", "ul", "ol", "dl", "blockquote"}
# After inline elements are there; before MkDocs collects anchors (5) and checks links (0).
PRIORITY = 8
_IS_FILE = re.compile(r"[\w/.-]+\.md")


class Links(Extension):  # type: ignore[misc]
    """Markdown's extension: `begin` tells which page is converted next."""

    def __init__(self) -> None:
        super().__init__()
        self.path = ""
        self.file: File | None = None
        self.files: Files | None = None

    def begin(self, path: str, file: File, files: Files) -> None:
        """Convert this page next.

        Parameters
        ----------
        path : str
            Its path in the repository.
        file : File
            Its file of the site.
        files : Files
            All files of the site.
        """
        self.path, self.file, self.files = path, file, files

    def extendMarkdown(self, md: Markdown) -> None:  # noqa: N802 - Markdown calls it
        """Register with Markdown."""
        md.treeprocessors.register(_Mender(md, self), "yehu-links", PRIORITY)

    def mended(self, link: str) -> str:
        """Return a link as MkDocs wants it: from source to source."""
        aim = target(link, self.path)
        if aim is None or self.file is None:
            return link
        uri, fragment = place(aim[0]), aim[1]
        between = get_relative_url(uri, self.file.src_uri)
        return f"{between}#{fragment}" if fragment else between

    def name(self, link: str, words: str) -> str | None:
        """Return a page's title where a link's words are its file; None where they are others."""
        aim = target(link, self.path)
        return title(aim[0]) if aim is not None and aim[0].endswith(words) else None

    def address(self, link: str) -> str | None:
        """Return the address of a mended link's file from this page; None if it is not there."""
        if self.file is None or self.files is None:
            return None
        uri = self.file.src_uri.rpartition("/")[0]
        found = self.files.get_file_from_path(_joined(uri, urlsplit(link).path))
        return None if found is None else found.url_relative_to(self.file)


class _Mender(Treeprocessor):  # type: ignore[misc]
    def __init__(self, md: Markdown, links: Links) -> None:
        super().__init__(md)
        self._links = links

    def run(self, root: Element) -> None:
        """Mend every link; add players below the blocks whose links lead to sounds."""
        parents = {child: parent for parent in root.iter() for child in parent}
        players: dict[Element, list[Element]] = {}
        for element in root.iter():
            if element.tag == "img":
                element.set("src", self._links.mended(element.get("src", "")))
            elif element.tag == "a":
                source = element.get("href", "")
                if len(element) == 0 and _IS_FILE.fullmatch(words := element.text or ""):
                    element.text = self._links.name(source, words) or words
                link = self._links.mended(source)
                element.set("href", link)
                if link.endswith(SOUNDS) and (address := self._links.address(link)):
                    block = element
                    while block.tag not in BLOCKS and block in parents:
                        block = parents[block]
                    players.setdefault(block, []).append(_player(element, address))
        for block, figures in players.items():
            if block in parents:
                _insert_after(parents[block], block, figures)
                if _words(block) == " ".join(_words(figure) for figure in figures):
                    parents[block].remove(block)  # it has no words but theirs


def _player(link: Element, address: str) -> Element:
    """The player of a sound, with the words of the link to it."""
    words = _words(link)
    figure = Element("figure")
    caption = Element("figcaption")
    caption.text = words
    audio = Element("audio", controls="", preload="none", src=address)
    audio.set("aria-label", words)
    figure.extend([caption, audio])
    return figure


def _words(element: Element) -> str:
    return " ".join("".join(element.itertext()).split())


def _insert_after(parent: Element, block: Element, figures: list[Element]) -> None:
    group = Element("div", {"class": "sounds"})
    group.extend(figures)
    group.tail, block.tail = block.tail, "\n"
    parent.insert(list(parent).index(block) + 1, group)


def _joined(folder: str, path: str) -> str:
    """A relative path from a folder, without its `..`."""
    parts = folder.split("/") if folder else []
    for part in path.split("/"):
        if part == "..":
            parts.pop()
        elif part != ".":
            parts.append(part)
    return "/".join(parts)
