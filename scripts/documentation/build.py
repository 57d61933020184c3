"""Build the documentation site, whole or not at all; ``scripts/site`` runs it."""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
import webbrowser
from pathlib import Path

from check import faults
from notebooks import RUN, run_all
from places import NOTEBOOK, NOTEBOOKS, ROOT

from yehu_server.cli.converters import port
from yehu_server.errors import OutputError, YehuError
from yehu_server.live.page.site import server_of, url_of

MARK = ".yehu-site"  # lists the files of a site, which the next one may replace
PORT = 8011


def build(folder: Path, *, runs: bool = False) -> int:
    """Build the site into a folder, in place of an earlier site there.

    Parameters
    ----------
    folder : Path
        A new or empty folder, or one with an earlier site.
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
        Where a notebook fails, MkDocs warns of something, or a link of the site leads nowhere.
    """
    folder = folder.absolute()
    check_folder(folder)
    try:
        folder.parent.mkdir(parents=True, exist_ok=True)
        scratch = Path(tempfile.mkdtemp(prefix=f".{folder.name}.", dir=folder.parent))
    except OSError as error:
        raise OutputError(f"{folder}: {error.strerror}") from error
    try:
        site = scratch / "site"
        notebooks = scratch / "notebooks" if runs else None
        if notebooks is not None:
            run_all(sorted((ROOT / NOTEBOOKS).glob(f"*{NOTEBOOK}")), notebooks)
        run_mkdocs(site, notebooks=notebooks)
        if found := list(faults(site)):
            more = f", and {len(found) - 1} more" if len(found) > 1 else ""
            raise YehuError(f"the site is not whole: {found[0]}{more}")
        (site / MARK).write_text("\n".join(sorted(_files_of(site))) + "\n", encoding="utf-8")
        _put(site, folder, scratch / "earlier")
        return len(list(folder.rglob("*.html")))
    except OSError as error:
        raise OutputError(f"{folder}: {error.strerror}") from error
    finally:
        shutil.rmtree(scratch, ignore_errors=True)


def check_folder(folder: Path) -> None:
    """Refuse a folder with files that no earlier build has written.

    Raises
    ------
    OutputError
        If it has some, or is no folder.
    """
    try:
        if not folder.exists():
            return
        others = sorted(path.name for path in folder.iterdir())
        mark = folder / MARK
        if mark.exists():
            ours = set(mark.read_text(encoding="utf-8").splitlines())
            others = sorted(_files_of(folder) - ours - {MARK})
    except OSError as error:
        raise OutputError(f"{folder}: {error.strerror}") from error
    if others:
        raise OutputError(
            f"{folder}: has other files, such as {others[0]}; name a new folder, or one of an "
            "earlier site"
        )


def _files_of(folder: Path) -> set[str]:
    """The files of a folder, by their paths in it."""
    return {
        (Path(root) / name).relative_to(folder).as_posix()
        for root, _, names in os.walk(folder)
        for name in names
    }


def run_mkdocs(
    site: Path, settings: Path = ROOT / "mkdocs.yml", *, notebooks: Path | None = None
) -> None:
    """Have MkDocs write a site; a warning of it is an error.

    Parameters
    ----------
    site : Path
        The folder to write.
    settings : Path
        MkDocs's own, with the folder of pages beside it.
    notebooks : Path, optional
        Where the notebooks are that were run.

    Raises
    ------
    YehuError
        Where MkDocs warns; what it says goes to stderr.
    """
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
        told = [line for line in done.stderr.splitlines() if not line.startswith(("INFO", "DEBUG"))]
        print(*told, sep="\n", file=sys.stderr)
        raise YehuError("MkDocs did not build the site: it says above why")


def _put(site: Path, folder: Path, earlier: Path) -> None:
    """Put the new site where the earlier one was."""
    if folder.exists():
        folder.rename(earlier)
    try:
        site.rename(folder)
    except OSError:
        if earlier.exists():
            earlier.rename(folder)
        raise


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
