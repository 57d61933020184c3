"""Build the documentation site, whole or not at all; ``scripts/site`` runs it."""

import argparse
import os
import subprocess
import sys
import tempfile
import webbrowser
from pathlib import Path

from notebooks import ROOT, RUN, run_all

from yehu_server.cli.converters import port
from yehu_server.errors import OutputError, YehuError
from yehu_server.live.page.site import server_of, url_of
from yehu_server.util.files import error_reason

MARK = ".yehu-site"  # lists the files of a site, which the next one may replace
PORT = 8011


def build(folder: Path, settings: Path = ROOT / "mkdocs.yml", *, runs: bool = False) -> int:
    """Build the site into a folder, in place of an earlier site there.

    Parameters
    ----------
    folder : Path
        A new or empty folder, or one with an earlier site.
    settings : Path
        MkDocs's own, with the folder of pages beside it.
    runs : bool
        Run the notebooks, to show what they draw and play.

    Returns
    -------
    int
        The number of pages.

    Raises
    ------
    OutputError
        Where the folder has other files, or cannot be written.
    YehuError
        Where a notebook fails, or MkDocs warns of something, such as a link that leads nowhere;
        what it says goes to stderr.
    """
    folder = folder.absolute()
    try:
        earlier = _files_of(folder)
        mark = folder / MARK
        ours = mark.read_text(encoding="utf-8").splitlines() if mark.exists() else []
        if others := sorted(earlier - {*ours, MARK}):
            raise OutputError(
                f"{folder}: has other files, such as {others[0]}; name a new folder, or one of an "
                "earlier site"
            )
        folder.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(prefix=f".{folder.name}.", dir=folder.parent) as scratch:
            site = Path(scratch) / "site"
            notebooks = Path(scratch) / "notebooks" if runs else None
            if notebooks is not None:
                run_all(notebooks)
            run_mkdocs(site, settings, notebooks)
            files = _files_of(site)
            (site / MARK).write_text("\n".join(sorted(files)) + "\n", encoding="utf-8")
            if folder.exists():
                folder.rename(Path(scratch) / "earlier")
            site.rename(folder)
        return sum(name.endswith(".html") for name in files)
    except OSError as error:
        raise OutputError(f"{folder}: {error_reason(error)}") from error


def _files_of(folder: Path) -> set[str]:
    """The files of a folder, by their paths in it; none where it does not exist."""
    if folder.exists():
        next(folder.iterdir(), None)  # an error where it is no folder, unlike rglob
    return {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}


def run_mkdocs(site: Path, settings: Path, notebooks: Path | None) -> None:
    """Have MkDocs write a site, strictly: a warning of it is an error."""
    # Not --quiet: with it, --strict counts no warnings.
    words = ["build", "--strict", "--config-file", settings, "--site-dir", site]
    done = subprocess.run(  # noqa: S603 - our own command
        [sys.executable, "-m", "mkdocs", *map(str, words)],
        cwd=settings.parent,
        env={**os.environ, "NO_MKDOCS_2_WARNING": "1", RUN: str(notebooks or "")},
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode:
        shown = [
            line for line in done.stderr.splitlines() if not line.startswith(("INFO", "DEBUG"))
        ]
        print(*shown, sep="\n", file=sys.stderr)
        raise YehuError("MkDocs did not build the site: it says above why")


def show(number: int, *, opens: bool, runs: bool) -> None:
    """Show the site to this machine until Ctrl-C."""
    with tempfile.TemporaryDirectory(prefix="yehu-site-") as scratch:
        site = Path(scratch) / "site"
        build(site, runs=runs)
        with server_of(site, number) as server:
            print(f"{url_of(server)}  (Ctrl-C ends it)", flush=True)
            if opens:
                webbrowser.open(url_of(server))
            try:
                server.serve_forever()
            except KeyboardInterrupt:
                return


def main() -> int:
    """Run the command line; return its exit code."""
    parser = argparse.ArgumentParser(
        prog="scripts/site",
        description="Build the documentation site into a folder; or show it to this machine.",
    )
    parser.add_argument("-o", "--output", type=Path, metavar="FOLDER", help="write the site here")
    parser.add_argument("--open", action="store_true", help="open it in the browser")
    parser.add_argument(
        "--run-notebooks",
        action="store_true",
        help="run the notebooks first, and show what they draw and play; takes minutes",
    )
    help_text = f"port to show it at; 0: a free one (default: {PORT})"
    parser.add_argument("--port", type=port, default=PORT, metavar="N", help=help_text)
    arguments = parser.parse_args()
    try:
        if arguments.output is None:
            show(arguments.port, opens=arguments.open, runs=arguments.run_notebooks)
        else:
            count = build(arguments.output, runs=arguments.run_notebooks)
            print(f"{arguments.output}: {count} pages; index.html is the first")
    except YehuError as error:
        print(f"scripts/site: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
