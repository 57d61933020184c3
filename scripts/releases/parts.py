"""What a release is made of, each part written into a folder of its own or a file."""

import email
import hashlib
import importlib.metadata
import re
import subprocess
import sys
import tarfile
import tempfile
import zipfile
from pathlib import Path

from releases import machine_code
from releases.citation import NotReadyError
from yehu_server.live.page.site import write_page
from yehu_server.plugin.build import build
from yehu_server.plugin.targets import ALL, NAMES

ROOT = Path(__file__).parents[2]
EARLIEST = (1980, 1, 1, 0, 0, 0)  # that an archive can state
EXECUTABLE = 0o755 << 16
# What a checkout does without, and a wheel has.
PAGE, CODE = Path("yehu_server/ahead/shipped"), Path("yehu_server/compile/shipped")
# What is inside of what we ship and is no package of Python's.
INSIDE = """\
| CLAP's headers | in the plug-in | MIT |
| LV2's headers | in the plug-in | ISC |
| DPF's travesty (VST3's interface) | in the plug-in | ISC |
| libc++'s headers and compiler-rt, by zig | in the plug-in | Apache-2.0 WITH LLVM-exception |
| mingw-w64's runtime | in the plug-in for Windows | ZPL-2.1 and public domain |
"""


def run(*command: str, folder: Path = ROOT) -> str:
    """Run a tool and return what it printed; raises NotReadyError if it fails."""
    done = subprocess.run(  # noqa: S603 - our own
        command, cwd=folder, capture_output=True, text=True, check=False
    )
    if done.returncode:
        raise NotReadyError(f"{' '.join(command)}\n{done.stdout}{done.stderr}".strip())
    return done.stdout


def page(folder: Path, version: str) -> list[Path]:
    """The page, for any web server; and packed."""
    write_page(folder / "page")
    return [pack(folder / "page", folder / f"yehu-{version}-page.zip", "yehu")]


def archives(folder: Path, version: str) -> list[Path]:
    """The source archive, and the wheel with page and machine code, of what is committed."""
    with tempfile.TemporaryDirectory() as scratch:
        copy = Path(scratch) / "yehu-server"
        run("git", "clone", "--quiet", "--no-hardlinks", str(ROOT), str(copy))
        write_page(copy / PAGE)
        machine_code.write_all(copy / CODE)
        run(sys.executable, "-m", "hatchling", "build", "-d", str(folder.absolute()), folder=copy)
    source, wheel = next(folder.glob("*.tar.gz")), next(folder.glob("*.whl"))
    check_archives(source, wheel, version)
    return [source, wheel]


def check_archives(source: Path, wheel: Path, version: str) -> None:
    """Check what both archives say and hold; raises NotReadyError."""
    with tarfile.open(source) as archive:
        metadata = archive.extractfile(f"{source.name.removesuffix('.tar.gz')}/PKG-INFO")
        texts = {source.name: metadata.read() if metadata else b""}
    with zipfile.ZipFile(wheel) as archive_of_wheel:
        names = archive_of_wheel.namelist()
        metadata_at = next(name for name in names if name.endswith(".dist-info/METADATA"))
        texts[wheel.name] = archive_of_wheel.read(metadata_at)
    for name, text in texts.items():
        fields = email.message_from_bytes(text)
        if (fields["Name"], fields["Version"]) != ("yehu-server", version):
            raise NotReadyError(f"{name} is of {fields['Name']} {fields['Version']}")
        if fields["Description-Content-Type"] != "text/markdown" or not fields.get_payload():
            raise NotReadyError(f"{name} has no README")
    for brought in (PAGE, CODE):
        if not any(name.startswith(f"{brought.as_posix()}/") for name in names):
            raise NotReadyError(f"{wheel.name} has nothing in {brought.as_posix()}")


def plugins(folder: Path, version: str) -> list[Path]:
    """An archive of the plug-in for each system; the same sources give the same archives."""
    with tempfile.TemporaryDirectory() as scratch:
        build(Path(scratch), ALL)
        more = {"README.md": ROOT / "docs" / "plugin.md", "LICENSE": ROOT / "LICENSE"}
        return [
            pack(Path(scratch) / name, folder / f"yehu-{version}-{name}.zip", "Yehu", more)
            for name in NAMES
        ]


def site(folder: Path, version: str) -> list[Path]:
    """The documentation's site, packed."""
    with tempfile.TemporaryDirectory() as scratch:
        built = Path(scratch) / "site"
        run(sys.executable, "scripts/documentation/build.py", "-o", str(built))
        return [pack(built, folder / f"yehu-{version}-site.zip", "yehu-site")]


def licences(folder: Path, version: str) -> list[Path]:
    """The list of all parts with their licences, those of `requirements/run.lock` as installed."""
    locked = (ROOT / "requirements" / "run.lock").read_text(encoding="utf-8")
    lines = []
    for name, of in re.findall(r"^([\w.-]+)==([\w.]+)", locked, re.MULTILINE):
        try:
            lines.append(f"| {name} {of} | a package | {_licence(name)} |")
        except importlib.metadata.PackageNotFoundError:
            lines.append(f"| {name} {of} | a package, not of this system | see its metadata |")
    text = f"""\
# Parts of yehu-server {version}

yehu-server itself is under the MIT licence (LICENSE). The wheel brings no other package: pip
installs them. They are listed as locked; those that build a wheel are among them.

| part | where | licence |
|---|---|---|
{INSIDE}{chr(10).join(lines)}
"""
    path = folder / "PARTS.md"
    path.write_text(text, encoding="utf-8")
    return [path]


def _licence(name: str) -> str:
    """The licence that an installed package states."""
    about = importlib.metadata.metadata(name)
    kinds = [
        line.rpartition(" :: ")[2]
        for line in about.get_all("Classifier", [])
        if line.startswith("License ::")
    ]
    expressions, licences = map(about.get_all, ("License-Expression", "License"))
    stated = ", ".join(expressions or kinds or licences or ["?"])
    return " ".join(stated.split("\n")[0].split())


def sums(folder: Path, _version: str) -> list[Path]:
    """The checksums of all files, but for the page's folder, which is packed beside it."""
    files = sorted(
        each for each in folder.iterdir() if each.is_file() and each.name != "SHA256SUMS"
    )
    lines = [f"{hashlib.sha256(file.read_bytes()).hexdigest()}  {file.name}\n" for file in files]
    path = folder / "SHA256SUMS"
    path.write_text("".join(lines), encoding="utf-8")
    return [path]


def pack(folder: Path, archive: Path, top: str, more: dict[str, Path] | None = None) -> Path:
    """Pack all files of a folder, and more by their names there, in order, as they would unpack."""
    found = (file for file in folder.rglob("*") if file.is_file())
    files = {file.relative_to(folder).as_posix(): file for file in found} | (more or {})
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as packed:
        for name, file in sorted(files.items()):
            entry = zipfile.ZipInfo(f"{top}/{name}", EARLIEST)
            entry.external_attr, entry.compress_type = EXECUTABLE, zipfile.ZIP_DEFLATED
            packed.writestr(entry, file.read_bytes())
    return archive
