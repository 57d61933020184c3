"""The documentation site: every page is there and leads somewhere."""

from html.parser import HTMLParser
from pathlib import Path

import pytest
import soundfile
from live.page.browser import drive, missing, running
from pages import ROOT

import yehu_server as yehu
from yehu_server import body, plot
from yehu_server.ahead.build import page_linker
from yehu_server.live.page.site import server_of, url_of

HERE = Path(__file__).parent
# Wide tables, wide code, pictures, a page of the interface, a notebook.
WIDEST = ["index.html", "derivation.html", "notation.html", "osc.html", "parameters.html"]
WIDEST += ["mappings.html", "api/render.html", "notebooks/1_first_sound.html"]


class Elements(HTMLParser):
    """The tags of a page's content, with their attributes, and its words."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.found: list[tuple[str, dict[str, str | None]]] = []
        self.words: list[str] = []
        _, _, content = text.partition("md-content__inner")
        self.text = (content or text).partition("</article>")[0]
        self.feed(self.text)

    def handle_starttag(self, tag, attrs):
        self.found.append((tag, dict(attrs)))

    def handle_data(self, data):
        self.words.append(data)

    def all(self, tag: str, attribute: str) -> list[str | None]:
        return [attributes.get(attribute) for name, attributes in self.found if name == tag]


@pytest.fixture(scope="module")
def site(tmp_path_factory) -> Path:
    """The site as `scripts/site -o` writes it, which refuses warnings and broken links."""
    if page_linker() is None:
        pytest.skip("there is no wasm-ld")
    folder = tmp_path_factory.mktemp("site") / "site"
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(ROOT / "scripts" / "documentation")
        import build

        build.build(folder)
    return folder


@pytest.fixture(scope="module")
def content(site):
    return lambda name: Elements((site / name).read_text(encoding="utf-8"))


@pytest.mark.slow
def test_links_out_of_the_docs_lead_to_pages_of_the_site(site, content):
    assert "mappings.html" in content("playing.html").all("a", "href")
    assert "begin.html" in content("pages.html").all("a", "href")
    assert "play/index.html" in content("index.html").all("a", "href")
    source = "source/yehu_server/core/engine/snapshot.py.html"
    assert source in content("page.html").all("a", "href")
    code = (ROOT / "yehu_server" / "core" / "engine" / "snapshot.py").read_text(encoding="utf-8")
    assert "".join(code.split()) in "".join("".join(content(source).words).split())
    assert (site / "play" / "yehu.wasm").read_bytes()[:4] == b"\0asm"
    assert "references.html#smith" in content("physics.html").all("a", "href")
    assert "smith" in content("references.html").all("a", "id")


@pytest.mark.slow
@pytest.mark.parametrize("module", [yehu, body, plot])
def test_every_public_name_has_a_place_on_the_pages_of_the_interface(content, site, module):
    names = {f"{module.__name__}.{name}" for name in module.__all__ if not name.startswith("_")}
    for path in (site / "api").glob("*.html"):
        names -= {row.get("id") for _, row in content(f"api/{path.name}").found}
    assert names == set()


# ---------------------------------------------------------------- in a browser


@pytest.fixture
def url(site):
    """The site, served to this machine."""
    with running(server := server_of(site, 0)):
        yield url_of(server)


@pytest.mark.slow
@pytest.mark.skipif(missing() is not None, reason=str(missing()))
@pytest.mark.parametrize("every", [False, True])
def test_in_a_browser_the_site_is_read_heard_and_searched_on_a_phone_too(site, url, every):
    names = [path.relative_to(site).as_posix() for path in sorted(site.rglob("*.html"))]
    names = [name for name in names if not name.startswith("play/")] if every else WIDEST
    seen = drive(str(HERE / "reading.mjs"), url, *names)
    assert (seen["elsewhere"], seen["errors"], seen["barriers"]) == ([], [], [])
    assert {name: width for name, width in seen["widths"].items() if width > seen["phone"]} == {}
    with soundfile.SoundFile(ROOT / "docs" / "sounds" / "held_note.flac") as sound:
        assert seen["seconds"] == pytest.approx(sound.frames / sound.samplerate, abs=0.1)
    assert any("glossary.html" in link for link in seen["found"])
