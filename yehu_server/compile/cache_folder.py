"""The folder of compiled code: where it is, what its name depends on, and when others go.

numba does not notice when a compiled function's callee changes in another file, so the name has a
hash of all sources that may be compiled; functions of other packages have one of their own.
"""

import errno
import os
import shutil
import time
from functools import cache
from importlib.metadata import version
from pathlib import Path

from platformdirs import user_cache_dir

from yehu_server.system.files import may_others_write
from yehu_server.util import PACKAGE
from yehu_server.util.source_key import key_of

PREFIX, DIGIT = "compiled-", "[0-9a-f]"
UNUSED_AFTER_S = 14 * 24 * 3600.0
# Of all source that is compiled, that makes code, or that compiled code reads constants of.
SOURCE_FOLDERS = ("core", "params", "compile", "system", "ahead")
others: dict[str, Path] = {}  # the same, of packages that use this one, by their names


def register(package: str, folder: Path) -> None:
    """Let another package have compiled code, from a folder of source.

    A change there compiles that package's code anew, and none of this one's.
    """
    others[package] = folder


@cache
def source_hash(package: str = "", *, is_shipped: bool = False) -> str:
    """Key of all source that compiled code comes from or reads constants of (16 hex digits).

    `package`: another one's name, for the key of its source and ours.
    `is_shipped`: of what a release brings, which is loaded without numba: with any version of it.
    """
    return key_of(sources(package), "" if is_shipped else version("numba"))


def sources(package: str = "") -> list[Path]:
    """All source that `source_hash` is of."""
    folders = [PACKAGE / folder for folder in SOURCE_FOLDERS]
    if package in others:
        folders.append(others[package])
    return [source for folder in folders for source in sorted(folder.rglob("*.py"))]


def key_beside(module: str) -> str:
    """What a function of a module is kept by beside the folder's name: another package's key."""
    package = module.partition(".")[0]
    return source_hash(package) if package in others else ""


def cache_folder() -> Path:
    """Where compiled code is kept; ``NUMBA_CACHE_DIR`` moves it."""
    root = os.environ.get("NUMBA_CACHE_DIR") or user_cache_dir("yehu-server", appauthor=False)
    return Path(root) / f"{PREFIX}{source_hash()}"


def data_folder() -> Path:
    """Where else is kept what takes long to find, such as calibrations."""
    return cache_folder().parent


OTHERS = "others may write there, and its code would be run"


def _open_cache() -> str:
    """Make the cache folder and drop what older sources left; return why nothing can be kept."""
    folder = cache_folder()
    try:
        folder.mkdir(0o700, parents=True, exist_ok=True)
        if may_others_write(folder):
            return OTHERS
        os.utime(folder)
        for other in folder.parent.glob(PREFIX + 16 * DIGIT):
            if time.time() - other.stat().st_mtime > UNUSED_AFTER_S:
                shutil.rmtree(other, ignore_errors=True)
    except OSError as error:
        return error.strerror or repr(error)
    return "" if os.access(folder, os.W_OK) else os.strerror(errno.EACCES)


WHY_NOT_CACHED = _open_cache()
IS_TRUSTED = WHY_NOT_CACHED != OTHERS  # else nothing there is read either
IS_CACHED = not WHY_NOT_CACHED  # else everything is compiled anew at each start
