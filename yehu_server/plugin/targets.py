"""The systems that a plug-in is built for, and how each names and arranges its files."""

from __future__ import annotations

import platform
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from yehu_server import system

if TYPE_CHECKING:  # the command line reads the names, and does not wait for LLVM
    from yehu_server.ahead.module import Target

LOWEST, WIDE = "x86-64-v2", "x86-64-v3"  # levels of processors
WIDE_PREFIX = "wide_"
X11 = "window_x11.cpp"


@dataclass(frozen=True)
class System:
    """A system and kind of processor."""

    name: str  # as `--target` has it; macOS is both of its processors
    triple: str  # LLVM's name
    zig: str  # zig's name
    ending: str  # of a shared library
    vst3: tuple[str, str]  # the folder of a VST3 bundle for the library, and its ending there
    cpu: str = LOWEST  # the least processor that it runs on, by LLVM's name
    is_released: bool = False  # for others' machines: by zig, which can ask for an old C library

    @property
    def has_wide(self) -> bool:
        """Whether it has a second version, for processors with AVX2."""
        return self.triple.startswith("x86_64")

    @property
    def window(self) -> str:
        """The source file of its windows; empty where the plug-in has none."""
        return {"linux": X11, "linux-arm": X11, "windows": "window_windows.cpp"}.get(self.name, "")

    @property
    def lv2_window(self) -> str:
        """The kind of its windows in LV2."""
        return {X11: "ui:X11UI", "": ""}.get(self.window, "ui:WindowsUI")

    @property
    def libraries(self) -> tuple[str, ...]:
        """Options to link what its windows need."""
        return {"windows": ("-lgdi32", "-luser32"), "macos": ()}.get(self.name, ("-ldl",))

    @property
    def is_here(self) -> bool:
        """Whether it is built on this machine for itself."""
        from llvmlite import binding

        is_ours = self.triple == binding.get_process_triple() and system.NAME == "linux"
        return is_ours and not self.is_released

    def target(self, *, wide: bool) -> Target:
        """What LLVM makes one of its versions for."""
        from yehu_server.ahead.module import Target

        if wide:
            return Target(self.triple, WIDE, prefix=WIDE_PREFIX, is_inner=True)
        return Target(self.triple, self.cpu, is_inner=True)


SYSTEMS = (
    System(
        "linux", "x86_64-unknown-linux-gnu", "x86_64-linux-gnu.2.31", ".so", ("x86_64-linux", ".so")
    ),
    System(
        "linux-arm",
        "aarch64-unknown-linux-gnu",
        "aarch64-linux-gnu.2.31",
        ".so",
        ("aarch64-linux", ".so"),
        cpu="generic",
    ),
    System(
        "windows", "x86_64-pc-windows-gnu", "x86_64-windows-gnu", ".dll", ("x86_64-win", ".vst3")
    ),
    System("macos", "x86_64-apple-macosx11.0.0", "x86_64-macos.11.0", ".dylib", ("MacOS", "")),
    System(
        "macos",
        "arm64-apple-macosx11.0.0",
        "aarch64-macos.11.0",
        ".dylib",
        ("MacOS", ""),
        cpu="apple-m1",
    ),
)
NAMES = tuple(dict.fromkeys(system.name for system in SYSTEMS))
ALL = "all"


def usual() -> str:
    """The name of this machine's own system."""
    is_arm = platform.machine() in {"aarch64", "arm64"}
    return "linux-arm" if is_arm and system.NAME == "linux" else system.NAME


def systems_of(name: str) -> list[System]:
    """The systems of a `--target`; those of ALL are released."""
    if name == ALL:
        return [replace(system, is_released=True) for system in SYSTEMS]
    return [system for system in SYSTEMS if system.name == name]
