"""Command lines: how a process runs one, and what an error looks like."""

COMMAND = "import sys; from yehu_server.cli import main; sys.exit(main(sys.argv[1:]))"


def is_one_line(text: str) -> bool:
    return text.endswith("\n") and text[:-1].isprintable() and len(text) > 10
