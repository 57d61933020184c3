"""What MkDocs calls while it builds the site: adds files, and mends links (``mkdocs.yml``).

Pages of ``docs/`` keep their places. Those that stand elsewhere, such as the README and
``mappings/README.md``, get one, so that links between pages lead to pages. Of other files a page
links to, texts of code become pages, and the rest is copied.
"""

import html
import logging
import os
import re
import tempfile
from functools import cache
from pathlib import Path, PurePosixPath
from posixpath import relpath
from urllib.parse import unquote, urlsplit

from latex2mathml.converter import convert
from mkdocs.config.defaults import MkDocsConfig
from mkdocs.exceptions import PluginError
from mkdocs.structure.files import File, Files, InclusionLevel
from mkdocs.structure.nav import Navigation
from mkdocs.structure.pages import Page
from notebooks import FOLDER, ROOT, fenced, shown

from yehu_server.errors import YehuError
from yehu_server.live.page.site import write_page

# Pages by their paths in the repository, and what MkDocs is to take them for.
ELSEWHERE = {
    "README.md": "begin.md",
    "CHANGELOG.md": "changes.md",
    "CONTRIBUTING.md": "contributing.md",
    "SECURITY.md": "security.md",
    "bench/results/following.md": "results/following.md",
    "bench/results/intonation.md": "results/intonation.md",
    "bench/results/performance.md": "results/performance.md",
    "bench/results/playability.md": "results/playability.md",
    "bench/results/reliability.md": "results/reliability.md",
    "bench/results/validation.md": "results/validation.md",
    "docs/README.md": "pages.md",
    "docs/site/home.md": "index.md",
    "mappings/README.md": "mappings.md",
    "presets/README.md": "presets.md",
    "tunings/README.md": "tunings.md",
}
PARTS = "docs/site/"  # what only the site has: its home, the pages of the API, its style
# The folder of the site that has the page of the instrument; links to its source lead there.
PLAY, INSTRUMENT = "play", "web/index.html"
REFERENCES = "docs/references.md"
ICON = "site/icon.svg"
LANGUAGES = {".c": "c", ".js": "js", ".mjs": "js", ".py": "python", ".sh": "bash", ".toml": "toml"}

_CODE = r"^(?P<fence>`{3,}).*?^(?P=fence)$|`[^`\n]+`"
_LINK = r"(?P<words>\[[\w/.-]+\.md)?\]\((?P<link>[^)\s]+)\)"
_FIGURE = re.compile(r"^!\[[^\]]*\]\((?P<link>[^)\s]+\.png)\)$", re.MULTILINE)
_MATH = re.compile(r"^```math\n(?P<tex>.*?)\n```$", re.MULTILINE | re.DOTALL)
_SOUND = re.compile(r"\[([^\]]+)\]\(([^)\s]+\.(?:flac|wav|ogg))\)")
_LOADED = re.compile(r'<(?!a\b)[^>]*?\b(?:src|srcset|poster|data)="((?:\w+:)?//[^"]+)')
# Kept until MkDocs ends, which may build many times (mkdocs serve).
_scratch = tempfile.TemporaryDirectory(prefix="yehu-site-")
log = logging.getLogger("mkdocs.hooks.yehu")  # strict builds count its warnings


def on_config(config: MkDocsConfig) -> MkDocsConfig:
    """Watch what pages stand outside of docs/."""
    config.watch += [str(ROOT / path) for path in ELSEWHERE]
    return config


def on_files(files: Files, *, config: MkDocsConfig) -> Files:
    """Add what is outside of docs/, the page of the instrument, and what links ask for."""

    def copy(uri: str, path: Path) -> None:
        files.append(File.generated(config, uri, abs_src_path=str(path)))

    def make(uri: str, content: str | bytes, *, is_in_nav: bool = True) -> None:
        kind = InclusionLevel.UNDEFINED if is_in_nav else InclusionLevel.NOT_IN_NAV
        files.append(File.generated(config, uri, content=content, inclusion=kind))

    for file in list(files):
        if place(f"docs/{file.src_uri}") != file.src_uri:
            files.remove(file)
    for path, uri in pages().items():
        if files.get_file_from_path(uri) is None:
            copy(uri, ROOT / path)
    for notebook in FOLDER.glob("*.ipynb"):
        text, outputs = shown(notebook)
        make(f"notebooks/{notebook.stem}.md", text)
        copy(f"notebooks/{notebook.name}", notebook)
        for name, data in outputs.items():
            make(f"notebooks/{name}", data)
    for path in sorted(linked_files()):
        if place(path).endswith(".md"):
            make(place(path), page_of_code(path), is_in_nav=False)
        else:
            copy(place(path), ROOT / path)
    copy(ICON, ROOT / "web" / "icon.svg")
    for name in _instrument():
        copy(f"{PLAY}/{name}", Path(_scratch.name) / name)
    return files


def on_nav(nav: Navigation, *, config: MkDocsConfig, files: Files) -> Navigation:  # noqa: ARG001
    """Leave the instrument's page out of the order of pages: it has no way on."""
    for page in nav.pages:
        if page.url.startswith(f"{PLAY}/"):
            before, after = page.previous_page, page.next_page
            if before is not None:
                before.next_page = after
            if after is not None:
                after.previous_page = before
    return nav


def on_page_markdown(markdown: str, *, page: Page, config: MkDocsConfig, files: Files) -> str:  # noqa: ARG001
    """Mend links, which are right in the repository; typeset equations; add players of sounds."""
    uri = page.file.src_uri
    paths = {uri: path for path, uri in pages().items()}
    text = mended(markdown, paths.get(uri, f"examples/{uri}"), uri)  # or a notebook
    text = _FIGURE.sub(r"[\g<0>](\g<link>)", text)  # a figure opens large
    text = _MATH.sub(lambda found: typeset(found["tex"]), text)
    return "\n\n".join(_with_players(block) for block in text.split("\n\n"))


def on_post_page(output: str, *, page: Page, config: MkDocsConfig) -> str:  # noqa: ARG001
    """Name the theme's dialog, for those who hear the page; warn of what is from elsewhere."""
    for address in _LOADED.findall(output):
        log.warning("%s: loads %s from elsewhere", page.file.src_uri, address)
    return output.replace('role="dialog">', 'role="dialog" aria-label="Search">')


# ---------------------------------------------------------------- where files stand


@cache
def pages() -> dict[str, str]:
    """Every page but notebooks, by its path in the repository: its place on the site."""
    found = (path.relative_to(ROOT).as_posix() for path in (ROOT / "docs").rglob("*.md"))
    return {path: place(path) for path in (*ELSEWHERE, *sorted(found))}


def place(path: str) -> str:
    """Return where a file of the repository stands among MkDocs's sources."""
    if path in ELSEWHERE:
        return ELSEWHERE[path]
    if path == INSTRUMENT:
        return f"{PLAY}/index.html"
    if (ROOT / path).parent == FOLDER:
        return f"notebooks/{PurePosixPath(path).name}".replace(".ipynb", ".md")
    if path.startswith("docs/"):
        return path.removeprefix(PARTS if path.endswith(".md") else "docs/").removeprefix("docs/")
    return f"source/{path}.md" if PurePosixPath(path).suffix in LANGUAGES else f"files/{path}"


def target(link: str, page: str) -> tuple[str, str] | None:
    """Return what a link of a page leads to: a path in the repository, and the fragment in it.

    None for links within the page and to other sites.
    """
    address = urlsplit(link)
    if address.scheme or address.netloc or not address.path:
        return None
    path = os.path.normpath(str(PurePosixPath(page).parent / unquote(address.path)))
    is_folder = (ROOT / path / "README.md").exists()
    return f"{path}/README.md" if is_folder else path, address.fragment


def linked_files() -> set[str]:
    """The files outside of ``docs/`` that pages link to, and that are no pages."""
    found = set()
    for page in pages():
        text = re.sub(
            _CODE, "", (ROOT / page).read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL
        )
        for link in re.finditer(_LINK, text):
            aim = target(link["link"], page)
            if aim and not aim[0].startswith("docs/") and (ROOT / aim[0]).is_file():
                found.add(aim[0])
    return {path for path in found - {*pages(), INSTRUMENT} if not path.endswith(".ipynb")}


def page_of_code(path: str) -> str:
    """Return the page that shows a file of code, as Markdown."""
    code = (ROOT / path).read_text(encoding="utf-8")
    hidden = "---\nsearch:\n  exclude: true\n---\n"
    return f"{hidden}\n# `{path}`\n\n{fenced(code, LANGUAGES[PurePosixPath(path).suffix])}\n"


@cache
def _instrument() -> list[str]:
    """Write the page of the instrument, once; its files.

    Raises PluginError where there is no module for it, and nothing to compile it with.
    """
    try:
        return [path.as_posix() for path in write_page(Path(_scratch.name))]
    except YehuError as error:
        raise PluginError(f"no page of the instrument: {error}") from error


# ---------------------------------------------------------------- what stands in pages


@cache
def _keys() -> str:
    """The keys of works in the references, as alternatives of a pattern."""
    text = (ROOT / REFERENCES).read_text(encoding="utf-8")
    return "|".join(re.findall(r"^\| \[([\w-]+)\] \|", text, re.MULTILINE))


def mended(text: str, path: str, uri: str) -> str:
    """Return a page with links as MkDocs wants them: from source (`uri`) to source.

    A link whose words are the name of a page's file gets the page's title instead. Keys of works,
    such as [Yehu], lead to their rows in the references. `path` is the page's in the repository.
    """
    folder = PurePosixPath(uri).parent.as_posix()

    def mend(found: re.Match[str]) -> str:
        if key := found["key"]:
            row = key.lower()
            if found["head"] and path == REFERENCES:
                return f'{found["head"]}<a id="{row}"></a>[\\[{key}\\]](#{row})'
            return f"{found['head'] or ''}[\\[{key}\\]]({relpath(place(REFERENCES), folder)}#{row})"
        if not found["link"] or (aim := target(found["link"], path)) is None:
            return found[0]
        words = found["words"] or ""
        if words and aim[0].endswith(words[1:]) and (title := _title(aim[0])):
            words = f"[{title}"
        link = relpath(place(aim[0]), folder)
        return f"{words}]({link}{'#' if aim[1] else ''}{aim[1]})"

    key = rf"(?P<head>^\| )?\[(?P<key>{_keys()})\](?![(\[])"
    return re.sub(f"{_CODE}|{_LINK}|{key}", mend, text, flags=re.MULTILINE | re.DOTALL)


def typeset(tex: str) -> str:
    """Return an equation in LaTeX as MathML, which browsers show by themselves."""
    return f'<div class="equation" tabindex="0">{convert(tex, display="block")}</div>'


def _title(path: str) -> str | None:
    """The title of a page by its path in the repository; None if it is no page."""
    if not (ROOT / path).is_file():
        return None
    found = re.search(r"^# +(.+?) *$", (ROOT / path).read_text(encoding="utf-8"), re.MULTILINE)
    return None if found is None else found[1].replace("`", "")


def _with_players(block: str) -> str:
    """A block of Markdown, and below it a player of each sound that it links to."""
    figures = []
    for words, link in _SOUND.findall(block):
        name = html.escape(" ".join(words.split()))
        figures.append(
            f"<figure><figcaption>{name}</figcaption>"
            f'<audio controls preload="none" src="{link}" aria-label="{name}"></audio></figure>'
        )
    if not figures:
        return block
    players = f'<div class="sounds">{"".join(figures)}</div>'
    return players if not _SOUND.sub("", block).strip() else f"{block}\n\n{players}"
