"""The site is written whole, and in place of an earlier site only."""

from __future__ import annotations

from pathlib import Path

import pytest
from documentation.made import WHOLE, written

from yehu_server.errors import OutputError, YehuError


@pytest.fixture
def mkdocs(scripts, monkeypatch):
    """An imitation of MkDocs, which writes these files."""
    files = dict(WHOLE)
    monkeypatch.setattr(scripts["build"], "run_mkdocs", lambda folder, **_: written(folder, files))
    return files


def names_in(folder: Path) -> set[str]:
    return {path.name for path in folder.iterdir()}


def test_a_site_replaces_an_earlier_one_whole(scripts, mkdocs, tmp_path):
    scripts["build"].build(tmp_path / "site")
    mkdocs["more.html"] = "<p>"
    del mkdocs["sub/index.html"]
    mkdocs["index.html"] = "<p>"
    scripts["build"].build(tmp_path / "site")
    assert names_in(tmp_path / "site") >= {"index.html", "more.html", "sub"}
    assert names_in(tmp_path / "site" / "sub") == {"other.html"}
    assert names_in(tmp_path) == {"site"}


@pytest.mark.usefixtures("mkdocs")
def test_a_folder_with_other_files_is_left_as_it_is(scripts, tmp_path):
    (tmp_path / "home").mkdir()
    (tmp_path / "home" / "diary.txt").write_text("mine")
    with pytest.raises(OutputError, match="has other files"):
        scripts["build"].build(tmp_path / "home")
    assert names_in(tmp_path / "home") == {"diary.txt"}


@pytest.mark.usefixtures("mkdocs")
def test_what_others_have_put_into_a_site_is_not_lost(scripts, tmp_path):
    scripts["build"].build(tmp_path / "site")
    (tmp_path / "site" / "sub" / "CNAME").write_text("example.org")
    with pytest.raises(OutputError, match=r"has other files, such as sub/CNAME"):
        scripts["build"].build(tmp_path / "site")
    assert (tmp_path / "site" / "sub" / "CNAME").read_text() == "example.org"


@pytest.mark.usefixtures("mkdocs")
def test_a_file_is_no_folder_for_a_site(scripts, tmp_path):
    (tmp_path / "site").write_text("mine")
    with pytest.raises(OutputError, match="Not a directory"):
        scripts["build"].build(tmp_path / "site")
    assert (tmp_path / "site").read_text() == "mine"


def test_a_site_with_a_broken_link_is_not_written(scripts, mkdocs, tmp_path):
    scripts["build"].build(tmp_path / "site")
    mkdocs["index.html"] = '<a href="none.html">'
    with pytest.raises(YehuError, match=r"index\.html: none\.html: no such file"):
        scripts["build"].build(tmp_path / "site")
    assert (tmp_path / "site" / "index.html").read_text() == WHOLE["index.html"]
    assert names_in(tmp_path) == {"site"}


@pytest.mark.parametrize(
    "page", ["[a link](none.md)", "[an anchor](index.md#none)", "[an anchor](#none)"]
)
def test_a_warning_of_mkdocs_is_an_error_and_told(scripts, tmp_path, capsys, page):
    settings = "site_name: s\nvalidation: {anchors: warn}\n"
    written(tmp_path, {"mkdocs.yml": settings, "docs/index.md": f"# Title\n\n{page}\n"})
    with pytest.raises(YehuError, match="MkDocs did not build"):
        scripts["build"].run_mkdocs(tmp_path / "site", tmp_path / "mkdocs.yml")
    assert "none" in capsys.readouterr().err
