"""Notebooks are shown as pages: text, code, and what is kept of their outputs."""

from __future__ import annotations

import json

import pytest

from yehu_server.errors import YehuError

PICTURE = "aGVs\nbG8="
PLAYER = '<audio controls src="data:audio/wav;base64,c291bmQ="></audio>'
CELLS = [
    {"cell_type": "markdown", "source": ["# A note\n", "\n", "Some words."]},
    {
        "cell_type": "code",
        "source": "print(1)",
        "outputs": [
            {"output_type": "stream", "text": ["1\n"]},
            {"output_type": "display_data", "data": {"image/png": PICTURE, "text/plain": "<F>"}},
            {"output_type": "execute_result", "data": {"text/plain": ["array", "(2)"]}},
            {"output_type": "display_data", "data": {"text/html": PLAYER, "text/plain": "<A>"}},
        ],
    },
    {"cell_type": "code", "source": [], "outputs": []},
]


def kept(folder, *cells):
    path = folder / "note.ipynb"
    path.write_text(json.dumps({"cells": list(cells), "metadata": {}, "nbformat": 4}))
    return path


def test_a_notebook_becomes_a_page_with_its_code_and_what_it_shows(scripts, tmp_path):
    page = scripts["notebooks"].shown(kept(tmp_path, *CELLS))
    assert page.text.rstrip().split("\n\n") == [
        "# A note",
        '<a href="note.ipynb" download>This notebook as a file</a>',
        "Some words.",
        "```python\nprint(1)\n```",
        "```text\n1\n```",
        "![what the code above draws](note_1.png)",
        "```text\narray(2)\n```",
        "[What the code above plays](note_2.wav)",
    ]
    assert page.files == {"note_1.png": b"hello", "note_2.wav": b"sound"}


def test_code_with_fences_in_it_gets_longer_ones(scripts, tmp_path):
    cell = {"cell_type": "code", "source": '"""```"""', "outputs": []}
    page = scripts["notebooks"].shown(kept(tmp_path, CELLS[0], cell))
    assert page.text.endswith('``````python\n"""```"""\n``````\n')


def code(source):
    return {
        "cell_type": "code", "source": source, "outputs": [], "metadata": {},
        "execution_count": None,
    }  # fmt: skip


def test_notebooks_are_run_and_their_outputs_shown(scripts, tmp_path, monkeypatch):
    title = {"cell_type": "markdown", "source": "# Sum", "metadata": {}}
    path = kept(tmp_path, title, code("print(20 + 22)"))
    scripts["notebooks"].run_all([path], tmp_path / "run")
    monkeypatch.setenv("YEHU_NOTEBOOKS", str(tmp_path / "run"))
    assert "```text\n42\n```" in scripts["notebooks"].shown(path).text
    assert json.loads(path.read_text())["cells"][1]["outputs"] == []


def test_a_notebook_that_fails_is_named(scripts, tmp_path, capfd):
    path = kept(tmp_path, code("1 / 0"))
    with pytest.raises(YehuError, match=r"note\.ipynb: does not run"):
        scripts["notebooks"].run_all([path], tmp_path / "run")
    assert "ZeroDivisionError" in capfd.readouterr().err
