"""Arrange linked libraries as each format and system wants them."""

import plistlib
import shutil
import struct
from collections.abc import Iterable, Mapping
from pathlib import Path

from yehu_server.plugin.carried import carried
from yehu_server.plugin.header import IDENTITY
from yehu_server.plugin.lv2_texts import manifest, plugin_text, presets_text
from yehu_server.plugin.parameters import parameters
from yehu_server.plugin.targets import System
from yehu_server.util import __version__

NAME = "Yehu"
# Of a file for several processors of macOS: what begins it, the processors by their numbers there,
# and the power of two that each begins at a multiple of.
FAT, PROCESSORS, PAGE = 0xCAFEBABE, {"x86_64": (0x01000007, 3), "arm64": (0x0100000C, 0)}, 14


def put_clap(folder: Path, libraries: Mapping[System, Path]) -> Path:
    """Put a CLAP plug-in into a folder: a file; on macOS a bundle."""
    path = folder / f"{NAME}.clap"
    if _is_mac(libraries):
        _put_mac(path, libraries)
    else:
        shutil.copyfile(next(iter(libraries.values())), path)
    return path


def put_vst3(folder: Path, libraries: Mapping[System, Path]) -> Path:
    """Put a VST3 plug-in into a folder: a bundle on all systems."""
    path = folder / f"{NAME}.vst3"
    if _is_mac(libraries):
        _put_mac(path, libraries)
    else:
        for system, library in libraries.items():
            inside, ending = system.vst3
            target = path / "Contents" / inside / f"{NAME}{ending}"
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(library, target)
    return path


def put_lv2(folder: Path, libraries: Mapping[System, Path]) -> Path:
    """Put an LV2 plug-in into a folder: a bundle of the library and texts on what it is."""
    path = folder / f"{NAME}.lv2"
    path.mkdir(exist_ok=True)
    data = carried()
    shown = parameters(data)
    system = next(iter(libraries))
    ending = system.ending
    (path / f"{NAME}{ending}").write_bytes(_joined(libraries))
    (path / "manifest.ttl").write_text(manifest(f"{NAME}{ending}", data, system.lv2_window))
    (path / f"{NAME}.ttl").write_text(plugin_text(shown))
    (path / "presets.ttl").write_text(presets_text(shown, data))
    return path


def _is_mac(libraries: Iterable[System]) -> bool:
    return all("apple" in system.triple for system in libraries)


def _put_mac(path: Path, libraries: Mapping[System, Path]) -> None:
    """Put a bundle of macOS: the library for all processors, and what it is."""
    binary = path / "Contents" / "MacOS" / NAME
    binary.parent.mkdir(parents=True, exist_ok=True)
    binary.write_bytes(_joined(libraries))
    properties = {
        "CFBundleExecutable": NAME,
        "CFBundleIdentifier": f"{IDENTITY}{path.suffix}",
        "CFBundleName": NAME,
        "CFBundlePackageType": "BNDL",
        "CFBundleSignature": "????",
        "CFBundleVersion": __version__,
        "CFBundleShortVersionString": __version__,
        "CFBundleInfoDictionaryVersion": "6.0",
        "LSMinimumSystemVersion": "11.0",
    }
    (path / "Contents" / "Info.plist").write_bytes(plistlib.dumps(properties))
    (path / "Contents" / "PkgInfo").write_text("BNDL????")


def _joined(libraries: Mapping[System, Path]) -> bytes:
    """The library of the only system, or one file of those for several processors."""
    codes = {one.triple.partition("-")[0]: file.read_bytes() for one, file in libraries.items()}
    if len(codes) == 1:
        return next(iter(codes.values()))
    heading, body = struct.pack(">II", FAT, len(codes)), b""
    at = 1 << PAGE
    for processor, code in codes.items():
        heading += struct.pack(">IIIII", *PROCESSORS[processor], at, len(code), PAGE)
        padded = code + bytes(-len(code) % (1 << PAGE))
        body, at = body + padded, at + len(padded)
    return heading + bytes((1 << PAGE) - len(heading)) + body
