"""Command lines: how a process runs one, what an error looks like, and what a batch wrote."""

from pathlib import Path

COMMAND = "import sys; from yehu_server.cli import main; sys.exit(main(sys.argv[1:]))"


def is_one_line(text: str) -> bool:
    return text.endswith("\n") and text[:-1].isprintable() and len(text) > 10


def results_in(out: Path) -> dict[str, bytes]:
    """All results of a batch, and its manifest, by their names."""
    return {
        str(path.relative_to(out)): path.read_bytes()
        for path in out.rglob("*")
        if path.is_file() and ".yehu-server" not in path.parts
    }
