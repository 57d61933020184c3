"""The documentation holds: links lead somewhere, commands run, files and addresses are there."""

from __future__ import annotations

import argparse
import json
import re
import runpy
import shlex
import tomllib
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import pytest
from pages import PACKAGE, PAGES, ROOT, Page, page

from yehu_server.cli import _parser, main
from yehu_server.live.osc.call_table import CALLS, PREFIX
from yehu_server.live.osc.part_status import PART_STATUS
from yehu_server.live.osc.status import STATUS
from yehu_server.params.table import TABLE, UNIT

each_page = pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
OURS = ("yehu-server", "scripts/yehu")
FOREIGN = (".venv/bin/pytest", ".venv/bin/mkdocs", "open-stage-control")
# What the table of parameters will know once the example of CONTRIBUTING.md is followed.
EXAMPLE = "/bow/turn"

# ---------------------------------------------------------------- links


@each_page
def test_every_link_leads_to_a_file_and_to_a_heading_in_it(page: Page):
    for link in page.links:
        address = urlsplit(link)
        if address.scheme:
            assert address.scheme == "https", link
            continue
        target = (page.path.parent / address.path).resolve() if address.path else page.path
        assert target.exists(), link
        if address.fragment:
            assert address.fragment in Page(target).anchors, link


@pytest.mark.parametrize("index", ["docs/README.md", "docs/decisions/README.md"])
def test_an_index_leads_to_every_page_beside_it(index):
    beside = {path.name for path in (ROOT / index).parent.glob("*.md")} - {"README.md"}
    assert beside - set(page(index).links) == set()


# ---------------------------------------------------------------- commands


def commands_of(parser: argparse.ArgumentParser) -> dict[str, argparse.ArgumentParser]:
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            return dict(action.choices)
    return {}


def options_of(parser: argparse.ArgumentParser) -> set[str]:
    """The options of a command and of its actions."""
    found = {option for action in parser._actions for option in action.option_strings}
    return found.union(*map(options_of, commands_of(parser).values()))


@cache
def project() -> dict[str, Any]:
    with (ROOT / "pyproject.toml").open("rb") as file:
        return tomllib.load(file)


@cache
def options_of_scripts() -> set[str]:
    """What scripts, benchmarks, the fuzzer and our tests' settings have for options."""
    files = [*(ROOT / "scripts").glob("*"), *(ROOT / "bench").glob("*.py")]
    files += [ROOT / "tests" / "conftest.py", *(ROOT / "tests" / "fuzz").glob("*.py")]
    texts = (file.read_text(encoding="utf-8") for file in files if file.is_file())
    return {option for text in texts for option in re.findall(r"(?<![\w-])--[a-z][\w-]*", text)}


def check_script(words: list[str]) -> None:
    """A script that is there, with options that it has."""
    script, *arguments = words
    text = (ROOT / script).read_text(encoding="utf-8")
    for argument in arguments:
        if argument.startswith("--"):
            assert argument in text, argument
        elif "/" in argument:
            assert (ROOT / argument).exists(), argument


def check_curl(words: list[str]) -> None:
    """An address of the tree, at the server's own."""
    (url,) = words
    address = urlsplit(url)
    assert address.netloc == _parser().parse_args(["serve"]).http
    assert address.path == "/" or is_known(address.path), url


def check_command(line: str) -> None:
    """What one may type: our command with arguments that it takes, or a tool of the checkout."""
    words = shlex.split(re.sub(r" {3,}.*|^NUMBA_DISABLE_JIT=1 ", "", line))
    if words[0].removeprefix(".venv/bin/") in OURS:
        try:
            _parser().parse_args(words[1:])
        except SystemExit as error:
            raise AssertionError(line) from error
    elif words[0] == ".venv/bin/python":
        check_script(words[1:])
    elif words[0] == "scripts/test":
        check_script(words)
    elif words[0] == ".venv/bin/pytest":
        for word in words[1:]:
            assert "/" not in word or (ROOT / word).exists(), word
    elif words[0] == "curl":
        check_curl(words[1:])
    elif words[0].startswith(PREFIX):
        assert is_known(words[0]), line
    else:
        assert words[0] in {"git", "cd", "scripts/lock", ".venv/bin/hatchling"}, line


@each_page
def test_every_command_in_a_block_can_be_given(page: Page):
    for line in page.commands():
        check_command(line)


PROGRAMS = [(page.name, block) for page in PAGES for block in page.blocks("python")]


@pytest.mark.parametrize(
    ("name", "program"), [row for row in PROGRAMS if row[1].startswith("import ")]
)
def test_every_program_runs(name, program, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    controls = {"bow_force": 0.7, "bow_velocity": 0.3}
    (tmp_path / "gesture.json").write_text(json.dumps({"duration": 0.01, "controls": controls}))
    assert main(["simulate", "gesture.json", "-o", "run.npz", "--energy"]) == 0
    capsys.readouterr()
    exec(compile(program, f"<{name}>", "exec"), {})  # noqa: S102 - our own documentation
    assert capsys.readouterr().out


@each_page
def test_every_command_and_option_in_a_sentence_is_there(page: Page):
    commands = commands_of(_parser())
    everywhere = options_of(_parser()) | options_of_scripts()
    for code in page.code:
        words = code.split()
        if words[0] in FOREIGN:
            continue
        if words[0] in OURS and len(words) > 1:
            words = words[1:]
            assert words[0] in commands or words[0].startswith("-"), code
        options = {word.partition("=")[0] for word in words if re.match(r"--[a-z]", word)}
        known = options_of(commands[words[0]]) if words[0] in commands else everywhere
        assert options <= known, code


# ---------------------------------------------------------------- files

FOLDERS = {path.name for path in (*ROOT.iterdir(), *PACKAGE.iterdir()) if path.is_dir()}
# Words in capitals stand for names that the reader gives; so do files of the reader's own.
PLACEHOLDER = re.compile(r"\b[A-Z]{2,}\b|\.\.\.")


def places(name: str, page: Page) -> Iterator[Path]:
    """Where a file that a page names may be."""
    for folder in (ROOT, PACKAGE, page.path.parent, ROOT / "tests"):
        yield from folder.glob(name)
    if "/" not in name:
        for folder in (PACKAGE, ROOT / "tests", ROOT / "docs", ROOT / "mappings"):
            yield from folder.rglob(name)


@each_page
def test_every_file_that_is_named_is_there(page: Page):
    installed = project()["tool"]["hatch"]["build"]["targets"]["wheel"]["sources"].values()
    for code in page.code:
        for word in code.split():
            name = word.rstrip("/")
            first, slash, _ = name.partition("/")
            is_source = re.fullmatch(r"[\w*-]+\.(py|md|html|pd|tosc|maxpat)", name)
            is_path = slash and first in FOLDERS and re.fullmatch(r"[\w./*-]+", name)
            if (is_source or is_path) and not PLACEHOLDER.search(name.removesuffix("README.md")):
                is_there = name in installed or next(places(name, page), None) is not None
                assert is_there, f"{page.name}: {name}"


def test_what_is_marked_as_generated_is_there():
    lines = (ROOT / ".gitattributes").read_text(encoding="utf-8").splitlines()
    patterns = [line.split()[0] for line in lines if line and not line.startswith("#")]
    assert patterns
    for pattern in patterns:
        assert next(ROOT.glob(pattern), None) is not None, pattern


def test_the_page_of_parameters_is_fresh():
    script = runpy.run_path(str(ROOT / "scripts" / "parameters.py"))
    assert script["page"]() == page("docs/parameters.md").text, (
        "docs/parameters.md is stale; run: .venv/bin/python scripts/parameters.py"
    )


@pytest.mark.parametrize(
    "block", page("CONTRIBUTING.md").blocks("diff"), ids=lambda block: block.splitlines()[0][4:]
)
def test_what_the_example_changes_stands_in_the_code(block):
    head, _, body = block.partition("\n")
    source = (ROOT / head.removeprefix("--- ")).read_text(encoding="utf-8")
    lines = body.splitlines()
    before, after = (
        "\n".join(line[1:] for line in lines if not line.startswith(sign)) for sign in "+-"
    )
    assert before in source or after in source  # to whoever has followed it, too


# ---------------------------------------------------------------- addresses


@cache
def addresses() -> set[str]:
    """Every address there is, and what is above it."""
    found = {EXAMPLE, *(param.address for param in TABLE), *(call.address for call in CALLS)}
    found |= {f"/status/{row.name}" for row in (*STATUS, *PART_STATUS)} | {"/status/NAME"}
    for file in (PACKAGE / "live").rglob("*.py"):  # what is answered
        found |= set(re.findall(r'["}](/[a-z/]+)"', file.read_text(encoding="utf-8")))
    groups = {"/" + "/".join(address.split("/")[1:depth]) for address in found for depth in (2, 3)}
    return found | groups


def is_known(address: str) -> bool:
    """Whether there is an address, as it is written with ``/yehu`` or without."""
    plain = address.removeprefix(PREFIX).removesuffix(".moved").removesuffix(UNIT)
    known = addresses() | {""}
    if below := re.fullmatch(r"/part/(?:N|\d+|\*)(/.*)?", plain):
        plain, known = (below[1] or "").removesuffix("/"), known | {"/fader1", "/NAME"}
    return plain.removesuffix("/...") in known


@each_page
def test_every_address_that_is_named_is_one(page: Page):
    groups = {PREFIX.strip("/"), *(param.address.split("/")[1] for param in TABLE)}
    for code in (*page.code, *page.blocks("toml"), *page.blocks("json")):
        for address in re.findall(r"(?<![\w./])/[a-z][\w/.]*(?![\w{])", code):
            if address.split("/")[1] in groups:
                assert is_known(address), f"{page.name}: {address}"


# ---------------------------------------------------------------- layers


def test_the_readme_has_the_layers_that_are_held():
    contract = project()["tool"]["importlinter"]["contracts"][0]
    held = [set(re.findall(r"\w+", layer)) for layer in contract["layers"] if "(" not in layer]
    table = page("README.md").text.partition("| layer | what it is for |\n|---|---|\n")[2]
    rows = table.partition("\n\n")[0].splitlines()
    assert [set(re.findall(r"`(\w+)`", row.split("|")[1])) for row in rows] == held
