"""The option of commands that can use a cluster."""

from __future__ import annotations

from typing import Any


def add_cluster(group: Any) -> None:
    """Add --dask, the address of a cluster's scheduler, to a parser or a group of its options."""
    group.add_argument(
        "--dask",
        metavar="ADDRESS",
        help="do the jobs on a cluster: the address of its Dask scheduler, such as "
        "tcp://10.0.0.1:8786, or the file it wrote (needs yehu-server[cluster])",
    )
