"""Make a data set of labelled sounds for machine learning, drawn at random as a description says.

Each sound comes with its forces, positions and velocities, and with the regime of the string.

  yehu-server dataset examples/dataset.toml -o strokes
  yehu-server dataset examples/dataset.toml -o strokes --count 100000 --dask tcp://10.0.0.1:8786

The format of descriptions, and what is written, is described in docs/dataset.md.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import secrets
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from yehu_server.cli.arguments import (
    add_cluster,
    add_command,
    add_folder,
    add_options,
    add_reporting,
    cluster_of,
)
from yehu_server.cli.converters import positive
from yehu_server.cli.terminal import compile_all, print_report, progress_bar, warn
from yehu_server.errors import OutputError, ParameterError
from yehu_server.rendering import build_records
from yehu_server.rendering.build_records import HIDDEN, check_manifest
from yehu_server.util.files import error_reason
from yehu_server.util.source_key import key_of

if TYPE_CHECKING:
    from yehu_lab.dataset.making import Part


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    parser = add_command(commands, "dataset", __doc__, run)
    add_options(parser, "description DESCRIPTION.toml: what to draw, and how", description=Path)
    add_folder(parser)
    add_options(
        parser,
        """
        --count N: number of sounds (default: as the description says)
        --jobs N: number of cores (default: all)
        """,
        count=positive,
        jobs=positive,
    )
    add_cluster(parser)
    add_reporting(parser)


def run(arguments: argparse.Namespace) -> int:
    """Run the command; return the exit code: 1 where some sounds failed."""
    from yehu_lab.dataset import making
    from yehu_lab.dataset.card import write_card
    from yehu_lab.dataset.description import read_description

    if arguments.dask is not None and arguments.jobs is not None:
        raise ParameterError("--jobs is for this machine: a cluster uses all of its workers")
    description = read_description(arguments.description)
    description = replace(description, count=arguments.count or description.count)
    folder: Path = arguments.output.absolute()
    _check_folder(folder)
    setup = partial(making.set_up, description.rate)
    if arguments.dask is None:
        compile_all(arguments)
        setup()
    with cluster_of(arguments, setup) as cluster, build_records.alone_in(folder):
        check_manifest(folder)
        build_records.clear_work([folder])
        parts = making.parts_of(description, folder, _key(description.key))
        left, lines = making.split_up_to_date(parts)
        current = len(lines)
        here = partial(_on_cores, arguments.jobs)
        perform_all = here if cluster is None else partial(_on_cluster, cluster, folder)
        try:
            with (
                progress_bar(arguments, "making", "sounds") as progress,
                contextlib.closing(making.make_all(left, perform_all)) as made,
            ):
                for more in made if left else ():
                    lines += more
                    progress(len(lines) - current, description.count - current)
        except KeyboardInterrupt:
            raise KeyboardInterrupt(
                f"{len(lines)} of {description.count} sounds are in {folder}; "
                "the same command goes on"
            ) from None
        finally:
            build_records.clear_work([folder])
            build_records.write_manifest(folder, lines, order="number")
            write_card(folder, description, lines)
    return _report(arguments, lines, current)


def _check_folder(folder: Path) -> None:
    """Refuse a folder with other things in it; raises OutputError where there are some."""
    try:
        is_other = any(folder.iterdir()) and not (folder / HIDDEN).is_dir()
    except FileNotFoundError:
        if folder.parent.is_dir():
            return
        raise OutputError(f"{folder}: the folder {folder.parent} does not exist") from None
    except NotADirectoryError:
        raise OutputError(f"{folder}: is a file; name a folder") from None
    except OSError as error:
        raise OutputError(f"{folder}: {error_reason(error)}") from error
    if is_other:
        raise OutputError(f"{folder}: is not empty, and is not a data set; name a new folder")


def _key(description: str) -> str:
    """Key of description and code."""
    from yehu_lab import dataset
    from yehu_server import playing, simulation
    from yehu_server.compile.cache_folder import source_hash

    folders = [Path(*package.__path__) for package in (playing, dataset, simulation)]
    code = [path for folder in folders for path in sorted(folder.glob("*.py"))]
    return key_of(code, source_hash("yehu_lab"), description)


def _on_cores(jobs: int | None, parts: Sequence[Part]) -> Any:
    from yehu_lab.dataset.making import perform
    from yehu_server.rendering.workers import perform_all

    return perform_all(perform, parts, min(jobs or os.cpu_count() or 1, len(parts)))


def _on_cluster(cluster: Any, folder: Path, parts: Sequence[Part]) -> Iterator[Any]:
    from yehu_lab.dataset.making import perform

    mark = folder / HIDDEN / f"seen-{secrets.token_hex(8)}"
    mark.touch()
    try:
        yield from cluster.perform_all(perform, (replace(part, mark=mark) for part in parts))
    finally:
        mark.unlink(missing_ok=True)


def _report(arguments: argparse.Namespace, lines: Sequence[dict[str, Any]], current: int) -> int:
    failed = [line for line in lines if "error" in line]
    for line in failed:
        warn(f"{line['file']}: {line['error']}")
    made = len(lines) - len(failed) - current
    regimes = Counter(line["labels"]["regime"] for line in lines if "labels" in line)
    fields = {"made": made, "up_to_date": current, "failed": len(failed), "regimes": regimes}
    counts = f"{made} made, {current} up to date, {len(failed)} failed"
    kinds = ", ".join(f"{count} {name}" for name, count in sorted(regimes.items()))
    print_report(arguments, fields, f"{arguments.output}: {counts} ({kinds})")
    return 1 if failed else 0
