"""A small site, whole."""

from __future__ import annotations

from pathlib import Path

WHOLE = {
    "index.html": '<h2 id="a b">A</h2><a href="sub/other.html#c">B</a><a href="#a%20b">A</a>'
    '<a href="https://example.org/">C</a><img src="data:image/png;base64,AAAA">'
    '<link rel="stylesheet" href="style.css"><a href="sub/">D</a><a href="">E</a>',
    "sub/index.html": '<a href="..">up</a><a href="/index.html">top</a>',
    "sub/other.html": '<p id="c"><img src="../picture.png"></p>',
    "style.css": "/* url(none.png) */ p { background: url('picture.png') }",
    "picture.png": "",
}


def written(folder: Path, files: dict[str, str]) -> Path:
    for name, text in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")
    return folder
