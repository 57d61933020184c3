"""The worked examples of CONTRIBUTING.md: made in a copy of the checkout, they do what they say."""

import os
import shlex
import shutil
import subprocess
import sys

import pytest
from pages import FENCED, ROOT, page

SECTIONS = page("CONTRIBUTING.md").text.split("\n## ")
EXAMPLES = {section.partition("\n")[0]: section for section in SECTIONS if section[:4] == "Add "}


def change(text: str, lines: list[str]) -> str:
    """A text with the lines of a diff."""
    old, new = ("".join(f"{line[1:]}\n" for line in lines if line[0] in of) for of in (" -", " +"))
    assert text.count(old) == 1, old
    return text.replace(old, new)


@pytest.mark.slow
@pytest.mark.parametrize("name", EXAMPLES)
def test_an_example_does_what_it_says(tmp_path, name):
    copy = tmp_path / "copy"
    shutil.copytree(ROOT, copy, ignore=shutil.ignore_patterns(".*", "node_modules", "__pycache__"))
    environment = os.environ | {"PYTHONPATH": str(copy)}
    for kind, block in FENCED.findall(EXAMPLES[name]):
        first, _, rest = block.partition("\n")
        if kind == "diff":
            file = copy / first.removeprefix("--- ")
            file.write_text(change(file.read_text("utf-8"), rest.splitlines()), "utf-8")
        elif kind == "python" and first.startswith("# tests/"):
            with (copy / first.removeprefix("# ")).open("a", encoding="utf-8") as file:
                file.write(f"\n\n{rest}")
        for line in block.splitlines() if kind == "" else ():
            tool, *arguments = shlex.split(line)
            if tool == "scripts/generate":
                command, folder = ["-m", "generators"], copy / "scripts"
            elif tool == ".venv/bin/pytest":
                command, folder = ["-m", "pytest", "-q", *arguments], copy
            else:
                continue
            done = subprocess.run(
                [sys.executable, *command],
                cwd=folder,
                env=environment,
                capture_output=True,
                text=True,
                check=False,
            )
            assert done.returncode == 0, f"{name}: {line}\n{done.stdout}{done.stderr}"
