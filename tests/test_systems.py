"""What differs between systems stands in one package, and its forms for other systems fit."""

import ctypes
import re
import sys
import threading
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import platformdirs
import pytest
from llvmlite import binding, ir
from platformdirs import windows as windows_dirs

from yehu_server.playing import mapping
from yehu_server.playing.preset_folders import Presets
from yehu_server.system import clocks, processes

ROOT = Path(__file__).parents[1]
HIGH_PRIORITY_CLASS = 0x80  # before most programs, after what has real time
ASKS = re.compile(
    r"\bsys\.platform\b|\bos\.name\b|\bplatform\.system\b|hasattr\((?:os|signal|socket)\b"
    r"|import (?:fcntl|resource|msvcrt|readline)\b|\bos\.(?:getuid|nice|memfd_create)\b"
    r"|\bctypes\.(?:WinDLL|windll)\b"
)


def test_no_other_module_asks_which_system_it_is_on():
    found = [
        f"{file.relative_to(ROOT)}: {line.strip()}"
        for package in ("yehu_server", "yehu_lab")
        for file in sorted((ROOT / package).rglob("*.py"))
        if "system" not in file.relative_to(ROOT / package).parts[:1]
        for line in file.read_text("utf-8").splitlines()
        if ASKS.search(line)
    ]
    assert found == []


@pytest.mark.parametrize("platform", ["linux", "win32"])
def test_clocks_are_code_that_llvm_takes_and_on_windows_none_with_steps_of_16_ms(
    monkeypatch, platform: str
):
    monkeypatch.setattr(sys, "platform", platform)
    for read in (clocks.monotonic_code, clocks.thread_cpu_code):
        module = ir.Module("clocks")
        function = ir.Function(module, ir.FunctionType(ir.IntType(64), []), "now")
        builder = ir.IRBuilder(function.append_basic_block("entry"))
        builder.ret(read(builder))
        binding.parse_assembly(str(module)).verify()
        assert ("QueryPerformanceCounter" in str(module)) == (platform == "win32")


@pytest.fixture
def windows(monkeypatch) -> dict[str, Any]:
    """What was asked of Windows' libraries, by the functions' names; they do as this test says."""
    asked: dict[str, Any] = {"time": 0}

    class Library:
        def __init__(self, name: str) -> None:
            self.name = name

        def GetCurrentProcess(self) -> int:
            return -1

        def GetSystemTimePreciseAsFileTime(self, into: Any) -> None:
            into._obj.value = asked["time"]

        def __getattr__(self, name: str) -> Any:
            return lambda *values: asked.update({f"{self.name}.{name}": values[-1]})

    monkeypatch.setattr(sys, "platform", "win32")
    monkeypatch.setattr(ctypes, "WinDLL", Library, raising=False)
    return asked


def test_on_windows_time_is_read_without_steps_of_16_ms(windows):
    began = datetime(1601, 1, 1, tzinfo=UTC)
    now = datetime(2026, 11, 29, 22, 0, 0, 123456, UTC)
    windows["time"] = (now - began) // timedelta(microseconds=1) * 10
    assert clocks.now_s() == pytest.approx(now.timestamp(), abs=1e-6)


def test_on_windows_what_plays_comes_before_busy_programs_and_waits_no_16_ms(windows):
    before = sys.getswitchinterval()
    try:
        processes.be_prompt()
    finally:
        sys.setswitchinterval(before)
    assert windows["kernel32.SetPriorityClass"] == HIGH_PRIORITY_CLASS
    assert windows["winmm.timeBeginPeriod"] == 1


def test_on_windows_no_wait_keeps_handlers_of_signals_from_running(monkeypatch: pytest.MonkeyPatch):
    waits = []

    class Ended(threading.Event):
        def wait(self, timeout: float | None = None) -> bool:
            waits.append(timeout)
            return len(waits) > 2

    monkeypatch.setattr(sys, "platform", "win32")
    processes.wait_for(Ended())
    assert waits == [processes.SIGNALS_EVERY_S] * 3


def test_on_windows_files_of_the_user_are_in_one_folder_as_those_of_the_cache(monkeypatch):
    monkeypatch.setattr(platformdirs, "PlatformDirs", windows_dirs.Windows)
    monkeypatch.setattr(windows_dirs, "get_win_folder", lambda _name: "/home/me/Local")
    own = Path("/home/me/Local/yehu-server")
    assert mapping.user_folder() == own / "mappings"
    assert Presets().own == own / "presets"
