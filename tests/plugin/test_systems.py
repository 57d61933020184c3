"""The plug-in for other systems than this one: what can be known of it without them."""

import plistlib
import shutil
import struct
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest
from plugin.conftest import HEADERS, HERE
from plugin.sounds import FRAMES, PHRASE, by_library, script

from yehu_server.plugin.build import build
from yehu_server.plugin.targets import SYSTEMS

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(find_spec("ziglang") is None, reason="there is no zig"),
]
WINE = shutil.which("wine64", path="/usr/bin:/usr/lib/wine")
QEMU = shutil.which("qemu-aarch64-static") or shutil.which("qemu-aarch64")
ARM = Path("/usr/aarch64-linux-gnu")  # its C library, of Debian's libc6-arm64-cross


@pytest.fixture(scope="module")
def everywhere(tmp_path_factory) -> Path:
    """A folder with the plug-in for all systems."""
    folder = tmp_path_factory.mktemp("everywhere")
    build(folder, "all")
    return folder


def compiled(tmp_path, system, source, *libraries):
    """A host, compiled for another system."""
    program, code = tmp_path / "host.exe", tmp_path / "host.o"
    zig = [sys.executable, "-m", "ziglang", "cc", "-target", system.zig]
    # Linked as the plug-in is: for other options zig would compile the system's libraries again.
    flags = ["-O1", "-DUNCOUNTED", f"-I{HEADERS}", "-c", str(HERE / source), "-o", str(code)]
    for options in (flags, ["-s", str(code), "-o", str(program), "-lm", *libraries]):
        subprocess.run([*zig, *options], check=True, capture_output=True)
    return program


def environment(tmp_path):
    """Of wine: its files lie in a folder that goes."""
    return {"WINEPREFIX": str(tmp_path / "wine"), "WINEDEBUG": "-all", "HOME": str(tmp_path)}


def played(tmp_path, system, command, plugin):
    """What the host, compiled for another system, plays by a plug-in of it."""
    lines, samples = (tmp_path / name for name in ("script", "samples"))
    program = compiled(tmp_path, system, "host.c")
    lines.write_text("".join(f"{line}\n" for line in ["0 play 1", *script(PHRASE)]))
    arguments = [str(plugin), "48000", "128", str(FRAMES), str(lines), str(samples)]
    subprocess.run([*command, str(program), *arguments], env=environment(tmp_path), check=True)
    return np.fromfile(samples, np.float32).reshape(-1, 2)


@pytest.mark.skipif(WINE is None, reason="there is no wine")
def test_on_windows_it_plays_the_same(everywhere, library, tmp_path):
    samples = played(tmp_path, SYSTEMS[2], [WINE], everywhere / "windows" / "Yehu.clap")
    np.testing.assert_allclose(samples, by_library(library, PHRASE, FRAMES), atol=1e-6)


@pytest.mark.skipif(WINE is None, reason="there is no wine")
def test_on_windows_a_screen_reader_hears_what_has_the_focus_and_its_value(
    everywhere, display, shown, tmp_path
):
    program = compiled(tmp_path, SYSTEMS[2], "windows_window.c", "-luser32")
    plugin, number = everywhere / "windows" / "Yehu.clap", shown["/playing/vibrato"].number
    done = subprocess.run(
        [WINE, str(program), str(plugin), "pttttt41r9e", str(number)],
        env={**environment(tmp_path), "DISPLAY": display},
        capture_output=True,
        text=True,
        check=True,
    )
    chosen, *names, value = done.stdout.splitlines()
    assert chosen == "Preset: pizzicato"
    words = ("Room: chamber", "Articulation: ordinary", "Mapping: keyboard", "Tuning: equal")
    assert tuple(names[:4]) == words
    assert names[5:] == [f"Vibrato: {word}" for word in ("4", "41", "41 cents", "9", "41 cents")]
    assert float(value) == 41.0


@pytest.mark.skipif(QEMU is None or not ARM.is_dir(), reason="there is no qemu, or no C of ARM")
def test_on_arm_it_plays_the_same(everywhere, library, tmp_path):
    samples = played(
        tmp_path, SYSTEMS[1], [QEMU, "-L", str(ARM)], everywhere / "linux-arm" / "Yehu.clap"
    )
    np.testing.assert_allclose(samples, by_library(library, PHRASE, FRAMES), atol=1e-6)


@pytest.mark.parametrize("name", ["Yehu.clap", "Yehu.vst3"])
def test_a_bundle_of_macos_has_both_processors_and_declares_what_it_is(everywhere, name):
    inside = everywhere / "macos" / name / "Contents"
    declared = plistlib.loads((inside / "Info.plist").read_bytes())
    binary = (inside / "MacOS" / declared["CFBundleExecutable"]).read_bytes()
    assert struct.unpack_from(">II", binary) == (0xCAFEBABE, 2)
    for number, processor in enumerate((0x01000007, 0x0100000C)):
        kind, _, at, size, power = struct.unpack_from(">IIIII", binary, 8 + 20 * number)
        assert kind == processor
        assert at % (1 << power) == 0
        assert struct.unpack_from("<II", binary, at) == (0xFEEDFACF, processor)
        entry = b"_clap_entry" if name == "Yehu.clap" else b"_GetPluginFactory"
        assert entry in binary[at : at + size]
