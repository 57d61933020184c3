"""Show the instrument as a web page on this machine until Ctrl-C, or write the page.

The written page is static files, for any web server.

  yehu-server page --open
  yehu-server page -o public/yehu
  yehu-server page --open --share-url https://example.org/yehu/

docs/page.md describes what the page does.
"""

import argparse
import contextlib
import io
import tempfile
import webbrowser
from pathlib import Path
from typing import Any, TextIO

from yehu_server.cli.arguments import add_command, add_folder, add_options
from yehu_server.cli.converters import port, web_address
from yehu_server.cli.terminal import print_result, warn

# White and black of the 256 colours, which themes leave alone; and back.
WHITE_ON_BLACK, PLAIN = "\x1b[38;5;231;48;5;16m", "\x1b[0m"


def show(text: str, stream: TextIO) -> None:
    """Draw a text as a QR code, where a terminal shows it."""
    if stream.isatty() and (stream.encoding or "").lower().startswith("utf"):
        with contextlib.suppress(OSError):  # the terminal was closed
            stream.write("".join(f"{line}\n" for line in drawn(text)))
            stream.flush()


def open_in_browser(url: str) -> None:
    """Open an address in the browser, or say where to go where there is none."""
    if not webbrowser.open(url):
        warn(f"--open: found no browser; open {url} in one")


def drawn(text: str) -> list[str]:
    """The lines of a QR code of a text: half a character is one module of it.

    It is black on white whatever the terminal's colours: most cameras do not read the inverse.
    """
    import segno

    lines = io.StringIO()
    segno.make_qr(text).terminal(lines, compact=True)  # its signs are what is white
    return [f"{WHITE_ON_BLACK}{line}{PLAIN}" for line in lines.getvalue().splitlines()]


PORT = 8010


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    parser = add_command(commands, "page", __doc__, run)
    command = "write the page here and end; the folder is created if missing"
    add_folder(parser, required=False, text=command)
    add_options(
        parser,
        f"""
        --port N: port to show it at; 0: a free one (default: {PORT})
        --open: open it in the browser
        --share-url URL: the address at which everybody can open this page, for links to
            performances (default: the address where a link is made)
        """,
        port={"type": port, "default": PORT},
        share_url={"type": web_address},
    )


def run(arguments: argparse.Namespace) -> int:
    """Run the command; return its exit code."""
    from yehu_server.live.page.site import write_page

    if arguments.output is not None:
        written = write_page(arguments.output, arguments.share_url or "")
        print_result(f"{arguments.output}: {len(written)} files; index.html is the page")
        return 0
    with tempfile.TemporaryDirectory(prefix="yehu-page-") as folder:
        write_page(Path(folder), arguments.share_url or "")
        _show(Path(folder), arguments.port, arguments.open)
    return 0


def _show(folder: Path, port: int, opens: bool) -> None:
    from yehu_server.live.page.site import server_of, url_of

    with server_of(folder, port) as server:
        print_result(f"{url_of(server)}  (Ctrl-C ends it)")
        if opens:
            open_in_browser(url_of(server))
        try:
            server.serve_forever()
        except KeyboardInterrupt:
            return
