"""Runs a notebook in a process of its own, as its reader would; used by tests.

    python tests/notebooks.py IN.ipynb OUT.ipynb

The kernel is reached by sockets of the file system, and no network.
"""

import sys
from pathlib import Path


def main(source: Path, target: Path) -> None:
    import nbformat
    from jupyter_client.manager import AsyncKernelManager
    from nbclient import NotebookClient

    class Local(AsyncKernelManager):
        """Reaches its kernel by sockets of the file system."""

        def __init__(self, **options) -> None:
            super().__init__(**options | {"transport": "ipc"})

    notebook = nbformat.read(source, as_version=4)
    NotebookClient(
        notebook, kernel_name="python3", kernel_manager_class=Local, timeout=600
    ).execute()
    nbformat.write(notebook, target)


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
