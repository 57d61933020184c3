"""Shows notebooks as pages: their text and code, and what running them shows and sounds."""

from __future__ import annotations

import base64
import json
import os
import re
import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from places import ROOT, fenced

from yehu_server.errors import YehuError

RUNNER = ROOT / "tests" / "notebooks.py"
RUN = "YEHU_NOTEBOOKS"  # where the notebooks are that were run, if they were
PICTURES = {"image/png": ".png", "image/jpeg": ".jpg"}
_PLAYER = re.compile(r'<audio[^>]* src="data:audio/wav;base64,([^"]+)"')


@dataclass
class Shown:
    """A notebook as Markdown, and the pictures and sounds that it links to, by their names."""

    text: str = ""
    files: dict[str, bytes] = field(default_factory=dict)


def shown(path: Path) -> Shown:
    """Return a notebook as a page.

    Parameters
    ----------
    path : Path
        The notebook (nbformat 4), whose first cell begins with its title. What it shows is taken
        from where notebooks were run, or else from its kept outputs.
    """
    if run := os.environ.get(RUN):
        path = Path(run) / path.name
    made = Shown()
    parts: list[str] = []
    for cell in json.loads(path.read_text(encoding="utf-8"))["cells"]:
        source = _text(cell["source"])
        if cell["cell_type"] == "markdown":
            parts.append(source)
        elif cell["cell_type"] == "code" and source.strip():
            parts.append(fenced(source, "python"))
            parts += [_output(output, path.stem, made.files) for output in cell["outputs"]]
    # As HTML, in which links are not mended: the file lies beside the page.
    file = f'<a href="{path.name}" download>This notebook as a file</a>'
    title, _, rest = "\n\n".join(part for part in parts if part).partition("\n")
    made.text = f"{title}\n\n{file}\n\n{rest.lstrip()}\n"
    return made


def run_all(paths: list[Path], folder: Path) -> None:
    """Run notebooks, and keep them with their outputs in a folder.

    Raises
    ------
    YehuError
        Where one fails; what it says goes to stderr.
    """
    folder.mkdir(parents=True)
    for path in paths:
        done = subprocess.run(  # noqa: S603 - our own command
            [sys.executable, str(RUNNER), str(path), str(folder / path.name)],
            cwd=folder,
            env={name: value for name, value in os.environ.items() if name != "MPLBACKEND"},
            capture_output=True,
            text=True,
            check=False,
        )
        if done.returncode:
            sys.stderr.write(done.stderr)
            raise YehuError(f"{path.name}: does not run; it says above why")


def _text(lines: str | list[str]) -> str:
    return lines if isinstance(lines, str) else "".join(lines)


def _output(output: dict[str, Any], stem: str, files: dict[str, bytes]) -> str:
    """What a cell has printed, drawn or let sound, as Markdown; its files are added to `files`."""
    if output["output_type"] == "stream":
        return fenced(_text(output["text"]), "text")
    data = {kind: _text(value) for kind, value in output.get("data", {}).items()}
    for kind, ending in PICTURES.items():
        if kind in data:
            name = _kept(data[kind], f"{stem}_{len(files) + 1}{ending}", files)
            return f"![what the code above draws]({name})"
    if player := _PLAYER.search(data.get("text/html", "")):
        name = _kept(player[1], f"{stem}_{len(files) + 1}.wav", files)
        return f"[What the code above plays]({name})"
    return fenced(data["text/plain"], "text") if "text/plain" in data else ""


def _kept(code: str, name: str, files: dict[str, bytes]) -> str:
    files[name] = base64.b64decode(code)
    return name
