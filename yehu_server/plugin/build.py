"""Build the plug-in: one file or folder for each format, and expression maps."""

import shutil
import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from yehu_server.ahead.build import HAVE_IT, run_compiler, zig
from yehu_server.errors import OutputError, YehuError
from yehu_server.plugin.bundles import put_clap, put_lv2, put_vst3
from yehu_server.plugin.carried import carried
from yehu_server.plugin.expression_maps import put_expression_maps
from yehu_server.plugin.header import header
from yehu_server.plugin.objects import make_objects, object_file
from yehu_server.plugin.parameters import parameters
from yehu_server.plugin.targets import ALL, X11, System, systems_of
from yehu_server.util.files import error_reason
from yehu_server.util.hints import install_command

SOURCE = Path(__file__).parent / "source"
COMMON = ("engine.cpp", "instrument.cpp", "resampler.cpp", "settings.cpp", "text.cpp")
CLAP = ("clap.cpp", "clap_notes.cpp")
VST3 = ("vst3.cpp", "vst3_processor.cpp", "vst3_controller.cpp", "vst3_notes.cpp")
# Of the window, where a system has one (`System.window`).
EDITOR = ("canvas.cpp", "editor.cpp")
HEADER_FILE = "carried.h"
# Where headers of the formats may lie, a file by which they are known, and their Debian packages.
SYSTEM, DPF = Path("/usr/include"), Path("/usr/share/dpf/distrho/src")
XCB = Path("xcb/xcb.h")
FLAGS = (
    *("-std=c++17", "-O2", "-ftree-vectorize", "-fPIC", "-fvisibility=hidden"),
    *("-fno-exceptions", "-fno-rtti", "-fno-threadsafe-statics", "-fno-math-errno"),
)
LINKING = ("-shared", "-s")
# The sources need C++'s headers, not its library, which zig would compile for each system, at its
# first use: a minute of processor time each.
COMPILER, LINKER = ("g++", "c++"), ("gcc", "cc")  # here, and of zig


@dataclass(frozen=True)
class Format:
    """A format of plug-ins."""

    name: str
    files: tuple[str, ...]  # the source files of its entry points
    # The folder of its headers; `sign` lies in it, and `package` of Debian's brings it.
    headers: Path
    sign: Path
    package: str
    # Puts linked libraries, by system, into a folder; returns what it wrote.
    put: Callable[[Path, Mapping[System, Path]], Path]
    editor: tuple[str, ...] = ()  # the source files of its window


FORMATS = (
    Format("CLAP", CLAP, DPF, Path("clap/entry.h"), "dpf-source", put_clap, ("clap_editor.cpp",)),
    Format("LV2", ("lv2.cpp",), SYSTEM, Path("lv2/core/lv2.h"), "lv2-dev", put_lv2),
    Format("VST3", VST3, DPF, Path("travesty/base.h"), "dpf-source", put_vst3, ("vst3_view.cpp",)),
)


def build(folder: Path, target: str) -> list[Path]:
    """Build all formats for a `--target` into a folder; for several, into a folder for each.

    Returns the files and bundles, and expression maps. Raises YehuError where something is missing
    to build with, or the folder cannot be written.

    `target`: one of `targets.NAMES`, or `targets.ALL`.
    """
    systems = systems_of(target)
    names = dict.fromkeys(system.name for system in systems)
    check_headers(target)
    for system in systems:
        tool_of(system, COMPILER)  # or there would be none after a minute of compiling
    try:
        with tempfile.TemporaryDirectory() as scratch:
            work = Path(scratch)
            make_objects(work, target)
            write_header(work)
            # And the formats' own, apart from those of this system that lie beside them.
            for inside, around in {(each.sign.parts[0], each.headers) for each in FORMATS}:
                (work / inside).symlink_to(around / inside)
            if any(system.window == X11 for system in systems):
                (work / XCB.parts[0]).symlink_to(SYSTEM / XCB.parts[0])
            return [
                path
                for name in names
                for path in _put(
                    folder / name if target == ALL else folder,
                    [system for system in systems if system.name == name],
                    work,
                )
            ]
    except OSError as error:
        raise OutputError(f"{error.filename or folder}: {error_reason(error)}") from error


def check_headers(target: str) -> None:
    """Raise YehuError, with the packages that have them, where headers of any kind are missing."""
    signs = {each.headers / each.sign: (each.name, each.package) for each in FORMATS}
    if any(system.window == X11 for system in systems_of(target)):
        signs[SYSTEM / XCB] = ("X's windows", "libxcb1-dev")
    missing = [found for sign, found in signs.items() if not sign.is_file()]
    if missing:
        names = ", ".join(name for name, _ in missing)
        packages = " ".join(dict.fromkeys(package for _, package in missing))
        raise YehuError(
            f"there are no headers of {names} here; on Debian: apt-get install {packages}"
        )


def write_header(work: Path) -> None:
    """Write the header of parameters and what is carried into a folder."""
    data = carried()
    (work / HEADER_FILE).write_text(header(parameters(data), data))


def _put(folder: Path, systems: Sequence[System], work: Path) -> list[Path]:
    folder.mkdir(parents=True, exist_ok=True)
    made = [
        each.put(folder, {system: link(each, system, work) for system in systems})
        for each in FORMATS
    ]
    return made + put_expression_maps(folder, carried())


def tool_of(system: System, names: tuple[str, str]) -> list[str]:
    """The command of COMPILER or LINKER for a system; raises YehuError if there is none."""
    here, of_zig = names
    if system.is_here and (found := shutil.which(here)):
        return [found]
    if (command := zig(of_zig)) is not None:
        return [*command, "-target", system.zig]
    if system.is_here:
        raise YehuError(f"there is no C++ compiler here; {HAVE_IT.format(here)}")
    raise YehuError(f"building for {system.name} needs zig: {install_command('plugin')}")


def compile_file(source: Path, into: Path, system: System, headers: Path) -> None:
    """Compile a source file to an object file, with the headers in a folder; raises YehuError."""
    run_compiler(
        [
            *tool_of(system, COMPILER),
            *FLAGS,
            *(("-DYEHU_EDITOR",) if system.window else ()),
            f"-I{SOURCE}",
            f"-I{headers}",
            "-c",
            str(source),
            "-o",
            str(into),
        ]
    )


def link(made: Format, system: System, work: Path) -> Path:
    """Compile and link a format's library for a system; return its file. Raises YehuError."""
    place = work / f"{system.triple}-{made.name}"
    place.mkdir(exist_ok=True)
    objects = []
    editor = (*EDITOR, system.window, *made.editor) if system.window else ()
    for name in (*COMMON, *made.files, *editor):
        objects.append(work / f"{system.triple}-{name}.o")
        if not objects[-1].exists():  # of another format
            compile_file(SOURCE / name, objects[-1], system, work)
    versions = (False, True) if system.has_wide else (False,)
    objects += [object_file(work, system, wide=wide) for wide in versions]
    library = place / f"Yehu{system.ending}"
    options = [*LINKING]
    if "linux" in system.triple:
        options += ["-Wl,--no-undefined", "-Wl,--build-id=none", "-Wl,-Bsymbolic"]
    if system.is_here:
        options += ["-static-libgcc", "-Wl,--as-needed"]
    parts = [*options, *map(str, objects), "-lm", *system.libraries]
    run_compiler([*tool_of(system, LINKER), *parts, "-o", str(library)])
    return library
