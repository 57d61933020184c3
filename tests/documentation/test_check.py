"""The checker of the site finds what leads nowhere, or is loaded from elsewhere."""

from __future__ import annotations

import pytest
from documentation.made import WHOLE, written


def test_the_checker_finds_no_fault_in_a_whole_site(scripts, tmp_path):
    assert list(scripts["check"].faults(written(tmp_path, WHOLE))) == []


@pytest.mark.parametrize(
    ("name", "text", "fault"),
    [
        ("index.html", '<a href="none.html">', "index.html: none.html: no such file"),
        ("index.html", '<a href="#none">', "index.html: #none: no such place in the page"),
        ("index.html", '<a href="sub/other.html#d">', "sub/other.html#d: no such place"),
        ("sub/other.html", '<img src="picture.png">', "sub/other.html: picture.png: no such file"),
        ("sub/other.html", '<audio src="none.flac">', "none.flac: no such file"),
        ("index.html", '<script src="https://x.org/a.js">', "loads https://x.org/a.js from"),
        ("index.html", '<img src="//x.org/a.png">', "loads //x.org/a.png from elsewhere"),
        ("index.html", '<link href="http://x.org/a.css">', "loads http://x.org/a.css from"),
        ("index.html", '<p style="background: url(http://x.org/a)">', "http://x.org/a from"),
        ("style.css", "@import 'https://x.org/a.css';", "style.css: loads https://x.org/a.css"),
        ("style.css", "p { background: url(none.png) }", "style.css: none.png: no such file"),
    ],
)
def test_the_checker_names_what_is_wrong(scripts, tmp_path, name, text, fault):
    (found,) = scripts["check"].faults(written(tmp_path, WHOLE | {name: WHOLE[name] + text}))
    assert fault in found
