"""The documentation holds: links and addresses lead somewhere, commands can be given, programs run.

Links are those of Markdown; how the site shows the pages is in tests/documentation/.
"""

import argparse
import json
import re
import shlex
from functools import cache
from pathlib import Path
from urllib.parse import urlsplit

import pytest
from generators.written import written
from pages import FENCED, PACKAGE, PAGES, ROOT
from pages import page as page_named

from yehu_server.cli import _parser, main
from yehu_server.live.network import HTTP_ADDRESS, OSC_ADDRESS
from yehu_server.live.osc.all_calls import CALLS, PREFIX
from yehu_server.live.osc.status import PART_STATUS, STATUS
from yehu_server.params.table import TABLE, UNIT

OURS = ("yehu-server", "scripts/yehu")
SLOW = {"docs/body.md"}  # whose programs take half a minute
# What there will be once the examples of CONTRIBUTING.md are followed.
EXAMPLE_ADDRESSES = {"/bow/turn", "/lift"}


# ---------------------------------------------------------------- what is written


def test_what_scripts_generate_writes_is_up_to_date():
    stale = [str(path.relative_to(ROOT)) for path, data in written() if path.read_bytes() != data]
    assert not stale, "run: scripts/generate"


@pytest.mark.parametrize("index", ["docs/README.md", "docs/decisions/README.md"])
def test_an_index_leads_to_every_page_beside_it(index):
    beside = {path.name for path in (ROOT / index).parent.glob("*.md")} - {"README.md"}
    assert {name for name in beside if f"]({name})" not in page_named(index).text} == set()


def test_what_is_read_is_short_enough_to_finish():
    assert len(page_named("README.md").text.split()) <= 900
    assert len((ROOT / "CHANGELOG.md").read_text("utf-8").splitlines()) <= 60
    rows = re.compile(r"^\|[-|]+$|\|", re.MULTILINE)  # bars of tables are no words
    docs = [page for page in PAGES if page.name.startswith("docs/")]
    assert sum(len(rows.sub(" ", page.text).split()) for page in docs) <= 55_000


def test_every_call_is_described():
    described = " ".join(page_named("docs/osc.md").code)
    assert [call.address for call in CALLS if PREFIX + call.address not in described] == []


# ---------------------------------------------------------------- commands


all_commands = cache(_parser)


def commands_of(parser: argparse.ArgumentParser) -> dict[str, argparse.ArgumentParser]:
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            return dict(action.choices)
    return {}


def options_of(parser: argparse.ArgumentParser) -> set[str]:
    """The options of a command and of its actions."""
    found = {option for action in parser._actions for option in action.option_strings}
    return found.union(*map(options_of, commands_of(parser).values()))


# Others' programs, and scripts that have no arguments here.
TOOLS = {
    *("git", "cd", "scripts/generate", "scripts/lock", "scripts/release", "hatchling", "pip"),
    *("sudo", "mkdir", "ln", "cp", "python3", "systemctl", "journalctl", "loginctl"),
}


def check_command(line: str) -> None:
    """What one may type: our command with arguments that it takes, or a tool of the checkout."""
    words = shlex.split(re.sub(r" {3,}.*|^[A-Z_]+=\S+ (pw-jack )?", "", line))
    tool = re.sub(r"^[\w.~/-]*/bin/", "", words[0])
    if tool in OURS:
        try:
            all_commands().parse_args(words[1:])
        except SystemExit as error:
            raise AssertionError(line) from error
    elif tool in {"python", "pytest", "scripts/test"}:
        script = ROOT / (words[1] if tool == "python" else "scripts/test")
        for word in words[1:]:
            if word.startswith("--"):
                assert word in script.read_text(encoding="utf-8"), word
            assert word.startswith("--") or "/" not in word or (ROOT / word).exists(), word
    elif tool == "curl":
        address = urlsplit(words[1])
        assert address.netloc == "{}:{}".format(*HTTP_ADDRESS)
        assert address.path == "/" or is_address(address.path), line
    elif tool.startswith(PREFIX):
        assert is_address(tool), line
    else:
        assert tool in TOOLS, line


def test_every_command_in_a_block_can_be_given(subtests):
    for page in PAGES:
        with subtests.test(page.name):
            for line in page.commands():
                check_command(line)


def test_a_server_is_where_it_listens_by_default(subtests):
    for page in PAGES:
        with subtests.test(page.name):
            ports = set(re.findall(r"(?:127\.0\.0\.1:|to port |on port )(\d+)", page.text))
            osc, http = OSC_ADDRESS[1], HTTP_ADDRESS[1]
            assert ports <= {str(osc), str(http), str(http + 1)}  # the last is the page's


@pytest.mark.parametrize(
    ("name", "program"),
    [
        pytest.param(page.name, block, marks=[pytest.mark.slow] * (page.name in SLOW))
        for page in PAGES
        for block in page.blocks("python")
    ],
)
def test_every_program_runs(name, program, tmp_path, monkeypatch, capsys):
    code = compile(program, f"<{name}>", "exec")
    if not program.startswith("import "):
        return  # a piece of one
    monkeypatch.chdir(tmp_path)
    controls = {"bow_force": 0.7, "bow_velocity": 0.3}
    (tmp_path / "gesture.json").write_text(json.dumps({"duration": 0.01, "controls": controls}))
    assert main(["simulate", "gesture.json", "-o", "run.npz", "--energy"]) == 0
    capsys.readouterr()
    exec(code, {})  # noqa: S102 - our own documentation
    assert capsys.readouterr().out


# ---------------------------------------------------------------- what is named


@cache
def addresses() -> set[str]:
    """Every address there is, and what is above it."""
    found = {*EXAMPLE_ADDRESSES, *(row.address for row in (*TABLE, *CALLS)), "/status/NAME"}
    found |= {f"/status/{row.name}" for row in (*STATUS, *PART_STATUS)}
    for file in (PACKAGE / "live").rglob("*.py"):  # what is answered
        found |= set(re.findall(r'["}](/[a-z/]+)"', file.read_text(encoding="utf-8")))
    groups = {"/" + "/".join(address.split("/")[1:depth]) for address in found for depth in (2, 3)}
    return found | groups | {""}


def is_address(address: str) -> bool:
    """Whether there is an address, as it is written with ``/yehu`` or without."""
    plain = address.removeprefix(PREFIX).removesuffix(".moved").removesuffix(UNIT)
    known = addresses()
    if below := re.fullmatch(r"/part/(?:N|\d+|\*)(/.*)?", plain):
        plain, known = (below[1] or "").removesuffix("/"), known | {"/fader1", "/NAME"}
    return plain.removesuffix("/...") in known


def anchors(path: Path) -> set[str]:
    """What a link may name of a page: its headings as GitHub and MkDocs spell them, and IDs."""
    text = path.read_text(encoding="utf-8")
    headings = re.findall(r"^#+ (.*)$", FENCED.sub("", text), re.MULTILINE)
    slugs = {re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-") for heading in headings}
    return slugs.union(re.findall(r'id="([^"]+)"', text))


def test_a_link_leads_to_what_is_there(subtests):
    for page in PAGES:
        with subtests.test(page.name):
            broken = []
            for link in re.findall(r"\]\(([^)\s]+)\)", page.prose):
                name, _, anchor = link.partition("#")
                path = page.path.parent / name if name else page.path
                if not urlsplit(link).scheme and not (
                    path.exists() and (not anchor or anchor in anchors(path))
                ):
                    broken.append(link)
            assert broken == []


@pytest.mark.parametrize("block", page_named("CONTRIBUTING.md").blocks("diff"))
def test_a_change_that_is_shown_can_be_made_or_was(block):
    head, *lines = block.splitlines()
    text = (ROOT / head.removeprefix("--- ")).read_text("utf-8")
    states = (
        "".join(f"{line[1:]}\n" for line in lines if line[0] in kept) for kept in (" -", " +")
    )
    assert any(state and text.count(state) == 1 for state in states)


def test_every_address_that_is_named_is_one(subtests):
    for page in PAGES:
        with subtests.test(page.name):
            groups = {PREFIX.strip("/"), *(param.address.split("/")[1] for param in TABLE)}
            for code in (*page.code, *page.blocks("toml"), *page.blocks("json")):
                for address in re.findall(r"(?<![\w./])/[a-z][\w/.]*(?![\w{])", code):
                    if address.split("/")[1] in groups:
                        assert is_address(address), address
