"""Makes keys of works, such as [Yehu], lead to their rows in the references."""

from __future__ import annotations

import re
from functools import cache
from re import Match
from xml.etree.ElementTree import Element

from markdown import Markdown
from markdown.extensions import Extension
from markdown.inlinepatterns import InlineProcessor
from markdown.treeprocessors import Treeprocessor
from places import ROOT

PAGE = "docs/references.md"
PRIORITY = 165  # before links by reference, after code
BEFORE_LINKS = 9  # in the tree, so that links are mended and anchors collected afterwards


@cache
def keys() -> list[str]:
    """The keys of the table of references."""
    text = (ROOT / PAGE).read_text(encoding="utf-8")
    return re.findall(r"^\| \[([\w-]+)\] \|", text, re.MULTILINE)


class Citations(Extension):  # type: ignore[misc]
    """Markdown's extension."""

    def extendMarkdown(self, md: Markdown) -> None:  # noqa: N802 - Markdown calls it
        """Register with Markdown."""
        pattern = rf"\[({'|'.join(keys())})\](?![(\[])"
        md.inlinePatterns.register(_Citation(pattern, md), "yehu-citations", PRIORITY)
        md.treeprocessors.register(_Rows(md), "yehu-references", BEFORE_LINKS)


class _Citation(InlineProcessor):  # type: ignore[misc]
    ANCESTOR_EXCLUDES = ("a",)

    def handleMatch(  # noqa: N802 - Markdown calls it
        self,
        m: Match[str],
        data: str,  # noqa: ARG002
    ) -> tuple[Element, int, int]:
        """Return the link, and where in the text it stands."""
        link = Element("a", {"class": "citation", "key": m[1]})
        link.text = f"[{m[1]}]"
        return link, m.start(0), m.end(0)


class _Rows(Treeprocessor):  # type: ignore[misc]
    def run(self, root: Element) -> None:
        """Give rows of the references their anchors; make citations elsewhere lead to them."""
        parents = {child: parent for parent in root.iter() for child in parent}
        for link in list(root.iter("a")):
            key = link.attrib.pop("key", None)
            if key is None:
                continue
            cell = parents[link]
            is_head = cell.tag == "td" and not (cell.text or "").strip() and cell[0] is link
            if is_head and self._is_first(parents[cell], cell):
                parents[cell].set("id", key.lower())
            link.set("href", f"/{PAGE}#{key.lower()}")

    @staticmethod
    def _is_first(row: Element, cell: Element) -> bool:
        return row[0] is cell
