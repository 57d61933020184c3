"""The site is written whole, in place of an earlier site only, and not where a link is broken."""

from pathlib import Path

import pytest

from yehu_server.errors import YehuError

HOOKS = Path(__file__).parents[2] / "scripts" / "documentation" / "hooks.py"


@pytest.fixture
def build(monkeypatch):
    """The build of a site of one page, by its text."""
    monkeypatch.syspath_prepend(HOOKS.parent)
    import build as scripts

    def build_page(folder: Path, text: str = "") -> None:
        source = folder.parent / "source"
        (source / "docs").mkdir(parents=True, exist_ok=True)
        (source / "mkdocs.yml").write_text(
            "site_name: s\ntheme: {name: null, custom_dir: theme}\n"
            "validation: {anchors: warn}\nplugins: []\n"
        )
        (source / "theme").mkdir(exist_ok=True)
        (source / "theme" / "main.html").write_text("{{ page.content }}")
        (source / "docs" / "index.md").write_text(f"# Title\n\n{text}\n")
        scripts.build(folder, source / "mkdocs.yml")

    return build_page


def names_in(folder: Path) -> set[str]:
    return {path.name for path in folder.iterdir()}


def test_a_site_replaces_an_earlier_one_whole(build, tmp_path):
    build(tmp_path / "site", "earlier")
    build(tmp_path / "site", "later")
    assert "later" in (tmp_path / "site" / "index.html").read_text()
    assert names_in(tmp_path) == {"site", "source"}


NIGHTLY = ("index.md#none", "#none", "none.png")


@pytest.mark.parametrize(
    "link", ["none.md", *(pytest.param(link, marks=pytest.mark.slow) for link in NIGHTLY)]
)
def test_a_site_with_a_broken_link_is_not_written(build, tmp_path, capsys, link):
    build(tmp_path / "site", "whole")
    with pytest.raises(YehuError, match="MkDocs did not build"):
        build(tmp_path / "site", f"[a link]({link})")
    assert "none" in capsys.readouterr().err
    assert "whole" in (tmp_path / "site" / "index.html").read_text()
    assert names_in(tmp_path) == {"site", "source"}
