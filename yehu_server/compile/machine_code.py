"""Machine code of all functions that playing calls, kept in one file and loaded without numba.

What simulations call besides is in another one, which playing does not load, and what each other
package compiles in one more.
A file is for one level of processors. Releases bring one for each, used where there is none
in the cache, so that a first start compiles nothing.

The file has a checksum. Inside are a line of JSON, which says what it was made for and all sizes,
and the functions' object files, compressed; each comes after those that it calls.
"""

import ctypes
import functools
import io
import json
import logging
import pickle
import zlib
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from yehu_server.compile import cache_folder, levels
from yehu_server.system import clocks
from yehu_server.system.files import c_library
from yehu_server.util.checksummed import ChecksumError, read_checksummed, write_checksummed

log = logging.getLogger(__name__)

FORMAT = 1
# What a file is for, beside the names of other packages; functions call those of files before them.
PLAYING, SIMULATING = "", "simulating"
# What numba's wrappers call where a function raises or counts references. None of ours does.
NEVER_CALLED = (
    "NRT_Free",
    "NRT_MemInfo_call_dtor",
    "numba_do_raise",
    "numba_gil_ensure",
    "numba_gil_release",
    "numba_runtime_build_excinfo_struct",
    "numba_unpickle",
)


def add_symbol(name: str, address: int) -> None:
    """Let what is loaded from now on find a function by its name."""
    from llvmlite import binding

    binding.add_symbol(name, address)


def made_for(sources: str) -> list[str]:
    """What code is made for here: the system, the level of processors, the sources."""
    return [levels.triple(), levels.level(), sources]


def file_in(folder: Path, what: str = PLAYING) -> Path:
    """The file of this level in a folder."""
    kind = f"-{what}" if what else ""
    return folder / f"{levels.triple()}-{levels.level()}{kind}.code"


def keep(folder: Path, sources: str, functions: Iterable[Any], what: str = PLAYING) -> None:
    """Write the file, of functions that are in the cache.

    `functions` (iterable of jit.Native): each after those that it calls.

    Raises OSError where it cannot be written; ChecksumError where the cache is damaged.
    """
    sizes, objects = [], []
    for function in functions:
        payload = read_checksummed(function.file)
        if payload is None:
            return
        read = io.BytesIO(payload)  # `function_cache.payload_of`
        (_, kind, parts), (described, *_) = pickle.load(read), pickle.load(read)  # noqa: S301 - with a checksum
        if kind != "object":
            return
        # Not as it is called in this process: another one may have put its own in the cache.
        entry = described.llvm_cfunc_wrapper_name
        sizes.append([function.name, entry, len(parts[0])])
        objects.append(parts[0])
    head = {"format": FORMAT, "made for": made_for(sources), "functions": sizes}
    body = zlib.compress(b"".join(objects), 1)
    write_checksummed(file_in(folder, what), json.dumps(head).encode() + b"\n" + body)


SHIPPED = Path(__file__).parent / "shipped"


def address_of(name: str, folder: Path) -> int | None:
    """The address of a function by its name, or None where it has to be compiled; as `loaded`."""
    for what in (PLAYING, SIMULATING, *cache_folder.others):
        found = loaded(folder, cache_folder.source_hash(what), what)
        if name in found or (not found and what == PLAYING):
            return found.get(name)
    return None


@functools.cache
def loaded(folder: Path, sources: str, what: str = PLAYING) -> dict[str, int]:
    """Load what is kept in a cache folder, or was shipped; return the functions' addresses by name.

    It is empty where they have to be compiled. `sources`: key of the source they were made from.
    """
    kept = [(folder, sources)] if cache_folder.IS_TRUSTED else []
    for place, key in (*kept, (SHIPPED, cache_folder.source_hash(what, is_shipped=True))):
        path = file_in(place, what)
        try:
            payload = read_checksummed(path)
            if payload is None:
                continue
            head, _, body = payload.partition(b"\n")
            about = json.loads(head)
            if about["format"] == FORMAT and about["made for"] == made_for(key):
                return _load(about["functions"], zlib.decompress(body))
        except (ChecksumError, ValueError, LookupError, TypeError, zlib.error) as error:
            log.warning("%s: %s; compiling anew", path, error)
    return {}


_engines: list[Any] = []  # they hold the code


def _load(functions: list[list[Any]], code: bytes) -> dict[str, int]:
    from llvmlite import binding

    binding.initialize_native_target()
    binding.initialize_native_asmprinter()
    machine = binding.Target.from_default_triple().create_target_machine(jit=True)
    engine = binding.create_mcjit_compiler(binding.parse_assembly(""), machine)
    _engines.append(engine)
    clocks.provide()
    abort = ctypes.cast(c_library().abort, ctypes.c_void_p).value or 0
    for name in NEVER_CALLED:
        binding.add_symbol(name, abort)
    found, begin = {}, 0
    for name, symbol, size in functions:
        if size:  # or it is in the object before it
            data = code[begin : begin + size]
            engine.add_object_file(binding.object_file.ObjectFileRef.from_data(data))
            engine.finalize_object()
        found[name] = engine.get_function_address(symbol)
        if found[name] == 0:
            raise ValueError(f"has no {symbol}")
        binding.add_symbol(name, found[name])
        begin += size
    return found
