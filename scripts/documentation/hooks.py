"""What MkDocs calls while it builds the site: adds files, and mends links (``mkdocs.yml``)."""

from __future__ import annotations

import tempfile
from functools import cache
from pathlib import Path, PurePosixPath

from citations import Citations
from links import Links
from mkdocs.config.defaults import MkDocsConfig
from mkdocs.exceptions import PluginError
from mkdocs.structure.files import File, Files, InclusionLevel
from mkdocs.structure.nav import Navigation
from mkdocs.structure.pages import Page
from notebooks import shown
from places import ELSEWHERE, NOTEBOOK, PLAY, ROOT, linked_files, page_of_code, pages, place

from yehu_server.errors import YehuError
from yehu_server.live.page.site import write_page

ICON = "site/icon.svg"
# Kept until MkDocs ends, which may build many times (mkdocs serve).
_scratch = tempfile.TemporaryDirectory(prefix="yehu-site-")
_links = Links()


def on_config(config: MkDocsConfig) -> MkDocsConfig:
    """Have Markdown mend links and citations, and watch what pages stand outside of docs/."""
    config.markdown_extensions += [_links, Citations()]
    config.watch += [str(ROOT / path) for path in ELSEWHERE]
    return config


def on_files(files: Files, *, config: MkDocsConfig) -> Files:
    """Add what is outside of docs/, the page of the instrument, and what links ask for."""
    moved = {path: uri for path, uri in pages().items() if f"docs/{uri}" != path}
    for file in list(files):
        if f"docs/{file.src_uri}" in moved:
            files.remove(file)
    for path, uri in moved.items():
        if path.endswith(NOTEBOOK):
            notebook = shown(ROOT / path)
            files.append(_made(config, uri, notebook.text))
            files.append(_file(config, str(PurePosixPath(uri).with_suffix(NOTEBOOK)), ROOT / path))
            for name, data in notebook.files.items():
                files.append(_made(config, place(f"{PurePosixPath(path).parent}/{name}"), data))
        else:
            files.append(_file(config, uri, ROOT / path))
    for path in linked_files():
        uri = place(path)
        if uri.endswith(".md"):
            files.append(_made(config, uri, page_of_code(path), InclusionLevel.NOT_IN_NAV))
        else:
            files.append(_file(config, uri, ROOT / path))
    files.append(_file(config, ICON, ROOT / "web" / "icon.svg"))
    for name in _instrument():
        files.append(_file(config, f"{PLAY}/{name}", Path(_scratch.name) / name))
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


def on_page_markdown(
    markdown: str,
    *,
    page: Page,
    config: MkDocsConfig,  # noqa: ARG001
    files: Files,
) -> str:
    """Tell the mender of links which page comes."""
    _links.begin(_path_of(page), page.file, files)
    return markdown


def on_post_page(output: str, *, page: Page, config: MkDocsConfig) -> str:  # noqa: ARG001
    """Name the theme's dialog, for those who hear the page."""
    return output.replace('role="dialog">', 'role="dialog" aria-label="Search">')


def _path_of(page: Page) -> str:
    """The path of a page in the repository."""
    paths = {uri: path for path, uri in pages().items()}
    return paths.get(page.file.src_uri, page.file.src_uri)


def _file(config: MkDocsConfig, uri: str, path: Path) -> File:
    return File.generated(config, uri, abs_src_path=str(path))


def _made(
    config: MkDocsConfig,
    uri: str,
    content: str | bytes,
    kind: InclusionLevel = InclusionLevel.UNDEFINED,
) -> File:
    return File.generated(config, uri, content=content, inclusion=kind)


@cache
def _instrument() -> list[str]:
    """Write the page of the instrument, once; its files.

    Raises
    ------
    PluginError
        Where there is no module for it, and nothing to compile it with.
    """
    try:
        return [path.as_posix() for path in write_page(Path(_scratch.name))]
    except YehuError as error:
        raise PluginError(f"no page of the instrument: {error}") from error
