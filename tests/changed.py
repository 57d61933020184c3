"""The tests that a change can reach, nearest first: ``pytest --changed [REVISION]``.

A test file reaches the modules that it, its helpers and its folder's fixtures name, and what those
import. Its distance is the number of imports to the nearest module that changed. Files that are no
modules reach the folders of FOLDERS, and test files that name them.
"""

from __future__ import annotations

import functools
import re
import subprocess
from collections.abc import Iterable
from pathlib import Path

import grimp

ROOT = Path(__file__).resolve().parents[1]
PACKAGES = ("yehu_server", "yehu_lab")
# What other files reach. A change of anything else reaches the files of tests that name it.
FOLDERS = {
    "web": ("tests/live/page", "tests/ahead"),
    "mappings": ("tests/surfaces", "tests/test_mappings_command.py"),
    "docs": ("tests/test_docs.py", "tests/documentation"),
}
_PACKAGE = "|".join(PACKAGES)
_RUN = re.compile(rf"\"((?:{_PACKAGE})(?:\.\w+)+)\"")  # a module that a process of its own runs
_MODULE = re.compile(rf"\b(?:{_PACKAGE})(?:\.\w+)+")
_IMPORT = re.compile(rf"^\s*from ((?:{_PACKAGE})[\w.]*) import \(?([\w\s,]+)", re.MULTILINE)
_HELPER = re.compile(r"^(?:from|import) ([a-z_][\w.]*)", re.MULTILINE)
_COMMAND = re.compile(r"\b(?:command|refused|mappings)\(\s*\"(\w+)\"")


def changed_files(revision: str) -> set[str]:
    """The files that differ from a revision, and those that git does not know yet."""
    commands = (["diff", "--name-only", revision], ["ls-files", "--others", "--exclude-standard"])
    return {
        line
        for words in commands
        for line in subprocess.run(
            ["git", *words],  # noqa: S607
            cwd=ROOT, capture_output=True, text=True, check=True,
        ).stdout.splitlines()
    }  # fmt: skip


def distances(changed: set[str], files: Iterable[Path]) -> dict[Path, int]:
    """How far each test file is from what changed; those out of reach are left out."""
    near = _distances_of_modules(changed)
    found = {}
    for file in set(files):
        modules, parts = _reach(file)
        reached = [near[module] + 1 for module in modules if module in near]
        reached += [0 for part in parts if _name(part) in changed]
        text = file.read_text(encoding="utf-8")
        for name in changed:
            folder = name.partition("/")[0]
            if any(_name(file).startswith(place) for place in FOLDERS.get(folder, ())) or (
                not name.endswith(".py") and Path(name).name in text
            ):
                reached.append(1)
        if reached:
            found[file] = min(reached)
    return found


def _distances_of_modules(changed: set[str]) -> dict[str, int]:
    """The number of imports from each module to one that changed."""
    graph = grimp.build_graph(*PACKAGES, cache_dir=str(ROOT / ".import_linter_cache"))
    for file in (file for name in PACKAGES for file in (ROOT / name).rglob("*.py")):
        name = _name(file).removesuffix(".py").removesuffix("/__init__").replace("/", ".")
        for run in set(_RUN.findall(file.read_text(encoding="utf-8"))) & graph.modules:
            graph.add_import(importer=name, imported=run)
    names = (name.removesuffix(".py").removesuffix("/__init__") for name in changed)
    level = {name.replace("/", ".") for name in names} & graph.modules
    near: dict[str, int] = {}
    while level:
        near |= dict.fromkeys(level, max(near.values(), default=-1) + 1)
        importers = (graph.find_modules_that_directly_import(module) for module in level)
        level = {one for some in importers for one in some} - near.keys()
    return near


def _name(path: Path) -> str:
    return path.relative_to(ROOT).as_posix()


def _reach(file: Path) -> tuple[set[str], set[Path]]:
    """The modules that a test file names, and the files of tests that it is made of."""
    fixtures = {folder / "conftest.py" for folder in file.parents if ROOT in folder.parents}
    parts = {file, *(one for one in fixtures if one.exists() and one.parent != ROOT / "tests")}
    waiting = list(parts)
    while waiting:
        for helper in _read(waiting.pop())[1] - parts:
            parts.add(helper)
            waiting.append(helper)
    return set().union(*(_read(part)[0] for part in parts)), parts


@functools.cache
def _read(file: Path) -> tuple[frozenset[str], frozenset[Path]]:
    """The modules that one file names, and the files beside it that it imports."""
    text = file.read_text(encoding="utf-8")
    modules = set(_MODULE.findall(text))
    for package, names in _IMPORT.findall(text):
        modules |= {f"{package}.{name.split()[0]}" for name in names.split(",") if name.strip()}
    commands = _COMMAND.findall(text)
    modules |= {f"{package}.cli.{name}" for package in PACKAGES for name in commands}
    # `a.b.name` may be a name of the module `a.b`.
    modules |= {module.rpartition(".")[0] for module in modules}
    places = [file.parent, ROOT / "tests"]
    names = [name.replace(".", "/") for name in _HELPER.findall(text)]
    helpers = {place / f"{name}.py" for name in names for place in places}
    return frozenset(modules), frozenset(helper for helper in helpers if helper.exists())
