"""``yehu-server page``."""

from __future__ import annotations

import argparse
import tempfile
import webbrowser
from pathlib import Path
from typing import Any

from yehu_server.cli.arguments import add_command, add_folder
from yehu_server.cli.converters import port
from yehu_server.cli.terminal import tell

EXAMPLES = """\
examples:
  yehu-server page --open
  yehu-server page -o public/yehu

docs/page.md tells what the page does.
"""
PORT = 8010


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    parser = add_command(
        commands,
        "page",
        run=run,
        help="the instrument in a web page, which sounds without a server",
        description="Show the instrument as a web page to this machine, until Ctrl-C; or write the "
        "page as static files, which may be put on any web server.",
        epilog=EXAMPLES,
    )
    wish = "write the page here and end; the folder is created if missing"
    add_folder(parser, required=False, text=wish)
    parser.add_argument(
        "--port",
        type=port,
        default=PORT,
        metavar="N",
        help=f"port to show it at; 0: a free one (default: {PORT})",
    )
    parser.add_argument("--open", action="store_true", help="open it in the browser")


def run(arguments: argparse.Namespace) -> int:
    """Run the command; return its exit code."""
    from yehu_server.panel.files import write_page

    if arguments.output is not None:
        written = write_page(arguments.output)
        tell(f"{arguments.output}: {len(written)} files; index.html is the page")
        return 0
    with tempfile.TemporaryDirectory(prefix="yehu-page-") as folder:
        write_page(Path(folder))
        _show(Path(folder), arguments.port, arguments.open)
    return 0


def _show(folder: Path, port: int, opens: bool) -> None:
    from yehu_server.panel.web_server import server_of, url_of

    with server_of(folder, port) as server:
        tell(f"{url_of(server)}  (Ctrl-C ends it)")
        if opens:
            webbrowser.open(url_of(server))
        try:
            server.serve_forever()
        except KeyboardInterrupt:
            return
