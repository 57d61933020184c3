"""The documentation site: every page is there, reads as on GitHub, and leads somewhere."""

from __future__ import annotations

import re
import threading
from collections import Counter
from pathlib import Path

import pytest
import soundfile
from documentation.elements import Elements, elements
from markdown_it import MarkdownIt
from pages import PAGES, ROOT, Page
from panel.browser import drive, missing

import yehu_server as yehu
from yehu_server import plot
from yehu_server.live.page.site import server_of, url_of

HERE = Path(__file__).parent

# Where pages of the repository stand on the site; docs/ itself is its root.
ELSEWHERE = {
    "README.md": "begin.html",
    "CONTRIBUTING.md": "contributing.html",
    "SECURITY.md": "security.html",
    "docs/README.md": "pages.html",
    "docs/site/home.md": "index.html",
    "docs/decisions/README.md": "decisions/index.html",
    "mappings/README.md": "mappings.html",
    "presets/README.md": "presets.html",
    "tunings/README.md": "tunings.html",
}
# Wide tables, wide code, pictures, a page of the interface, a notebook.
WIDEST = ["index.html", "derivation.html", "notation.html", "osc.html", "parameters.html"]
WIDEST += ["mappings.html", "api/render.html", "notebooks/1_first_sound.html"]
IS_API = re.compile(r"^::: ", re.MULTILINE)
PROSE = [page for page in PAGES if not IS_API.search(page.text)]
each_page = pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
each_page_of_prose = pytest.mark.parametrize("page", PROSE, ids=lambda page: page.name)
# What GitHub makes of Markdown and the site has to make, too.
STRUCTURE = {"blockquote", "em", "h1", "h2", "h3", "h4", "img", "li", "ol", "pre", "strong"}
STRUCTURE |= {"table", "td", "th", "tr", "ul"}


def place(page: Page) -> str:
    name = page.name.removeprefix("docs/").removeprefix("site/")
    return ELSEWHERE.get(page.name, f"{name.removesuffix('.md')}.html")


# ---------------------------------------------------------------- pages


@each_page
def test_every_page_is_on_the_site_and_in_its_navigation(site, page: Page):
    led = {
        attributes.get("href")
        for tag, attributes, around in elements(site, "index.html").found
        if tag == "a" and "md-sidebar--primary" in around
    }
    assert place(page) in led
    assert (site / place(page)).is_file()


@each_page_of_prose
def test_a_page_has_the_headings_of_its_source_by_the_fragments_of_github(site, page: Page):
    ids = {attributes.get("id") for _, attributes, _ in elements(site, place(page)).found}
    assert page.anchors - ids == set()


@each_page_of_prose
def test_a_page_reads_on_the_site_as_on_github(site, page: Page):
    github = Elements(MarkdownIt("commonmark").enable("table").render(page.text))
    here = elements(site, place(page))
    inside = [tag for tag, _, around in here.found if "md-content__inner" in around]
    expected = Counter(tag for tag, _, _ in github.found if tag in STRUCTURE)
    assert Counter(tag for tag in inside if tag in STRUCTURE) == expected


DOCS = [page for page in PAGES if "/decisions/" not in page.name and page.name != "SECURITY.md"]


@pytest.mark.parametrize("page", DOCS, ids=lambda page: page.name)
def test_a_page_begins_with_its_title_and_says_what_it_is_for(page: Page):
    title, first, *_ = page.prose.split("\n\n")
    assert re.fullmatch(r"# [^\n]+[^.\n]", title.strip())
    assert re.match(r"[A-Z0-9`一-鿿][^|]*[.:]", first.lstrip(), re.DOTALL), first
    assert not re.match(r"(#|\||- |\d+\. |!\[|```|:::)", first.lstrip())


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_a_page_has_one_title(page: Page):
    assert len(re.findall(r"^# ", page.prose, re.MULTILINE)) == 1


# ---------------------------------------------------------------- what the site adds


def test_links_out_of_the_docs_lead_to_pages_of_the_site(site):
    links = {
        (name, attributes.get("href"))
        for name in ("playing.html", "architecture.html", "page.html", "mappings.html")
        for tag, attributes, _ in elements(site, name).found
        if tag == "a"
    }
    assert ("playing.html", "mappings.html") in links
    assert ("architecture.html", "begin.html#layers") in links
    assert ("page.html", "source/yehu_server/core/engine/look.py.html") in links
    assert ("mappings.html", "playing.html#velocity") in links
    code = elements(site, "source/yehu_server/core/engine/look.py.html").text_in("pre")
    source = (ROOT / "yehu_server" / "core" / "engine" / "look.py").read_text(encoding="utf-8")
    assert code == " ".join(source.split())


def test_links_named_by_a_file_are_named_by_its_title(site):
    words = {
        " ".join(text.split())
        for text, around in elements(site, "pages.html").words
        if around[-1:] == ["a"]
    }
    assert {"How it plays", "Glossary", "Mappings", "README"} <= words
    for page in PROSE:
        for text, around in elements(site, place(page)).words:
            assert not (around[-1:] == ["a"] and text.endswith(".md")), f"{page.name}: {text}"


def test_links_to_sounds_have_players_below(site):
    sounds = [
        link
        for page in PAGES
        for link in page.links
        if link.endswith(".flac") and page.name == "docs/playing.md"
    ]
    assert sounds
    players = [row for row in elements(site, "playing.html").found if row[0] == "audio"]
    assert [attributes["src"] for _, attributes, _ in players] == sounds
    for _, attributes, around in players:
        assert "controls" in attributes
        assert attributes["preload"] == "none"
        assert "p" not in around
    for link in sounds:
        assert (site / link).read_bytes() == (ROOT / "docs" / link).read_bytes()


def test_keys_of_works_lead_to_the_references(site):
    cited = {
        attributes["href"] for tag, attributes, _ in elements(site, "physics.html").found
        if tag == "a" and attributes.get("class") == "citation"
    }  # fmt: skip
    assert "references.html#smith" in cited
    rows = [
        attributes for tag, attributes, _ in elements(site, "references.html").found if tag == "tr"
    ]
    assert "smith" in {attributes.get("id") for attributes in rows}


def test_the_site_has_the_instrument(site):
    assert (site / "play" / "yehu.wasm").read_bytes()[:4] == b"\0asm"
    assert (site / "play" / "main.js").read_bytes() == (ROOT / "web" / "main.js").read_bytes()
    home = elements(site, "index.html").found
    assert any(tag == "a" and row.get("href") == "play/index.html" for tag, row, _ in home)


@pytest.mark.parametrize(("module", "names"), [(yehu, yehu.__all__), (plot, plot.__all__)])
def test_every_public_name_has_a_place_on_the_pages_of_the_interface(site, module, names):
    ids = {
        attributes.get("id")
        for path in (site / "api").glob("*.html")
        for _, attributes, _ in elements(site, f"api/{path.name}").found
    }
    expected = {f"{module.__name__}.{name}" for name in names if not name.startswith("_")}
    assert expected - ids == set()


# ---------------------------------------------------------------- in a browser


@pytest.fixture
def url(site):
    """The site, served to this machine."""
    with server_of(site, 0) as server:
        thread = threading.Thread(target=server.serve_forever, daemon=True)
        thread.start()
        yield url_of(server)
        server.shutdown()
        thread.join()


in_a_browser = pytest.mark.skipif(missing() is not None, reason=str(missing()))


@pytest.mark.slow
@in_a_browser
def test_in_a_browser_the_site_is_read_heard_and_searched_and_loads_nothing_from_elsewhere(url):
    seen = drive(str(HERE / "reading.mjs"), url, *WIDEST)
    assert seen["elsewhere"] == []
    assert seen["errors"] == []
    assert {name: width for name, width in seen["widths"].items() if width > seen["phone"]} == {}
    with soundfile.SoundFile(ROOT / "docs" / "sounds" / "held_note.flac") as sound:
        assert seen["seconds"] == pytest.approx(sound.frames / sound.samplerate, abs=0.1)
    assert any("glossary.html" in link for link in seen["found"])
    assert seen["barriers"] == []


@pytest.mark.slow
@in_a_browser
def test_every_page_fits_a_phone_and_loads_nothing_from_elsewhere(site, url):
    names = [path.relative_to(site).as_posix() for path in sorted(site.rglob("*.html"))]
    names = [name for name in names if not name.startswith("play/")]
    seen = drive(str(HERE / "reading.mjs"), url, *names)
    assert (seen["elsewhere"], seen["errors"]) == ([], [])
    assert {name: width for name, width in seen["widths"].items() if width > seen["phone"]} == {}
