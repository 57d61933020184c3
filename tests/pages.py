"""The documentation's pages, and what stands in them: prose, code, blocks."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "yehu_server"
FENCED = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
CODE = re.compile(r"(?<!`)`([^`\n]+)`(?!`)")


@dataclass(frozen=True)
class Page:
    """One page of the documentation."""

    path: Path

    @property
    def name(self) -> str:
        """Its path in the repository."""
        return self.path.relative_to(ROOT).as_posix()

    @cached_property
    def text(self) -> str:
        return self.path.read_text(encoding="utf-8")

    @cached_property
    def prose(self) -> str:
        """The text without its blocks of code."""
        return FENCED.sub("", self.text)

    def blocks(self, language: str) -> list[str]:
        """The blocks of code in a language; "" is for those that name none."""
        return [block for name, block in FENCED.findall(self.text) if name == language]

    @cached_property
    def code(self) -> list[str]:
        """What stands between backquotes, but for what is told of as history."""
        paragraphs = re.split(r"\n\s*\n", self.prose)
        return CODE.findall("\n".join(each for each in paragraphs if "history" not in each))

    def commands(self) -> Iterator[str]:
        """The lines of its blocks that one types, with continued ones in one."""
        for block in self.blocks(""):
            if not re.match(r"[\s│┌]", block):
                yield from block.replace("\\\n", " ").splitlines()


PAGES = [
    Page(path)
    for path in (
        *(ROOT / name for name in ("README.md", "CONTRIBUTING.md", "SECURITY.md")),
        *sorted((ROOT / "docs").rglob("*.md")),
        *sorted((ROOT / "bench" / "results").glob("*.md")),
        *(ROOT / folder / "README.md" for folder in ("mappings", "presets", "tunings")),
    )
]


def page(name: str) -> Page:
    """A page by its path in the repository."""
    return next(page for page in PAGES if page.name == name)
