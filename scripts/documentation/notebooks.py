"""Shows notebooks as pages: their text and code, and what running them shows and sounds."""

import base64
import json
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

from yehu_server.errors import YehuError

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "examples" / "notebooks"
RUNNER = ROOT / "tests" / "notebooks.py"
RUN = "YEHU_NOTEBOOKS"  # where the notebooks are that were run, if they were
PICTURES = {"image/png": ".png", "image/jpeg": ".jpg"}
_PLAYER = re.compile(r'<audio[^>]* src="data:audio/wav;base64,([^"]+)"')


def shown(path: Path) -> tuple[str, dict[str, bytes]]:
    """Return a notebook as Markdown, and the pictures and sounds that it links to, by name.

    `path`: the notebook (nbformat 4), whose first cell begins with its title. What it shows is
    taken from where notebooks were run, or else from its kept outputs.
    """
    if run := os.environ.get(RUN):
        path = Path(run) / path.name
    files: dict[str, bytes] = {}
    parts: list[str] = []
    for cell in json.loads(path.read_text(encoding="utf-8"))["cells"]:
        source = "".join(cell["source"])
        if cell["cell_type"] == "markdown":
            parts.append(source)
        elif source.strip():
            parts.append(fenced(source, "python"))
            parts += [_output(output, path.stem, files) for output in cell["outputs"]]
    title, _, rest = "\n\n".join(part for part in parts if part).partition("\n")
    # As HTML, in which links are not mended: the file lies beside the page.
    file = f'<a href="{path.name}" download>This notebook as a file</a>'
    return f"{title}\n\n{file}\n\n{rest.lstrip()}\n", files


def run_all(folder: Path) -> None:
    """Run the notebooks, and keep them with their outputs in a new folder.

    Raises YehuError where one fails; what it says goes to stderr.
    """
    folder.mkdir(parents=True)
    for path in sorted(FOLDER.glob("*.ipynb")):
        done = subprocess.run(  # noqa: S603 - our own command
            [sys.executable, str(RUNNER), str(path), str(folder / path.name)],
            cwd=folder,
            env={name: value for name, value in os.environ.items() if name != "MPLBACKEND"},
            stderr=subprocess.PIPE,
            text=True,
            check=False,
        )
        if done.returncode:
            sys.stderr.write(done.stderr)
            raise YehuError(f"{path.name}: does not run; it says above why")


def fenced(code: str, language: str) -> str:
    """Return a block of code, as Markdown."""
    fence = "`" * (3 + max(map(len, re.findall("`+", code)), default=0))
    return f"{fence}{language}\n{code.rstrip()}\n{fence}"


def _output(output: dict[str, Any], stem: str, files: dict[str, bytes]) -> str:
    """What a cell has printed, drawn or let sound, as Markdown; its files are added to `files`."""
    if output["output_type"] == "stream":
        return fenced("".join(output["text"]), "text")
    data = {kind: "".join(value) for kind, value in output.get("data", {}).items()}
    for kind, ending in PICTURES.items():
        if kind in data:
            name = f"{stem}_{len(files) + 1}{ending}"
            files[name] = base64.b64decode(data[kind])
            return f"![what the code above draws]({name})"
    if player := _PLAYER.search(data.get("text/html", "")):
        name = f"{stem}_{len(files) + 1}.wav"
        files[name] = base64.b64decode(player[1])
        return f"[What the code above plays]({name})"
    return fenced(data["text/plain"], "text") if "text/plain" in data else ""
