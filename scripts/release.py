"""Build and check what a release uploads, and print what a person runs to upload it.

    .venv/bin/python scripts/release.py FOLDER

Writes into FOLDER, which is new or empty, the source archive, the wheel, their SHA256SUMS, and
zenodo.json: CITATION.cff as the metadata of a deposit, which is archived with a DOI. Uploads
nothing. What comes before is in CONTRIBUTING.md, "Make a release".
"""

from __future__ import annotations

import argparse
import email
import hashlib
import importlib.util
import json
import re
import subprocess
import sys
import tarfile
import tomllib
import zipfile
from pathlib import Path
from typing import Any

import yaml

ROOT = Path(__file__).parents[1]
# What a checkout does without, and a wheel should have: the page's module, and machine code.
SHIPPED = {
    "scripts/ship_page.py": "yehu_server/ahead/shipped/",
    "scripts/machine_code.py": "yehu_server/compile/shipped/",
}


class NotReadyError(Exception):
    """What stands in the way of a release."""


def zenodo(citation: dict[str, Any]) -> dict[str, Any]:
    """Return the metadata of a deposit of what a CITATION.cff cites."""
    found = {
        "upload_type": "software",
        "access_right": "open",
        "title": citation["title"],
        "version": str(citation["version"]),
        "description": citation["abstract"].strip(),
        "creators": [_creator(author) for author in citation["authors"]],
        "license": citation["license"].lower(),
        "keywords": citation["keywords"],
        "references": [_reference(work) for work in citation.get("references", ())],
    }
    if "date-released" in citation:
        found["publication_date"] = str(citation["date-released"])
    return {"metadata": found}


def _creator(author: dict[str, Any]) -> dict[str, str]:
    if "name" in author:
        return {"name": author["name"]}
    found = {"name": f"{author['family-names']}, {author['given-names']}"}
    if "affiliation" in author:
        found["affiliation"] = author["affiliation"]
    if "orcid" in author:
        found["orcid"] = author["orcid"].rpartition("/")[2]
    return found


def _reference(work: dict[str, Any]) -> str:
    names = "; ".join(_creator(author)["name"] for author in work["authors"])
    where = [str(work[field]) for field in ("collection-title", "year", "doi") if field in work]
    return ", ".join([f"{names}: {work['title']}", *where])


def check_versions(root: Path) -> str:
    """Return the version that all files agree on; raises NotReadyError."""
    project = tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    version: str = project["version"]
    cited = str(read_citation(root)["version"])
    if cited != version:
        raise NotReadyError(f"CITATION.cff is of {cited}, pyproject.toml of {version}")
    changes = (root / "CHANGELOG.md").read_text(encoding="utf-8")
    if not re.search(rf"^## {re.escape(version)}\b", changes, re.MULTILINE):
        raise NotReadyError(f"CHANGELOG.md has no section `## {version}`")
    return version


def read_citation(root: Path) -> dict[str, Any]:
    """Return the entries of CITATION.cff."""
    found: dict[str, Any] = yaml.safe_load((root / "CITATION.cff").read_text(encoding="utf-8"))
    return found


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
    for script, folder in SHIPPED.items():
        if not any(name.startswith(folder) for name in names):
            raise NotReadyError(f"{wheel.name} has nothing in {folder}: run {script} first")


def run(*command: str) -> str:
    """Run a tool in the checkout and return what it printed; raises NotReadyError if it fails."""
    done = subprocess.run(  # noqa: S603 - our own
        command, cwd=ROOT, capture_output=True, text=True, check=False
    )
    if done.returncode:
        raise NotReadyError(f"{' '.join(command)}\n{done.stdout}{done.stderr}")
    return done.stdout


def release(folder: Path) -> list[Path]:
    """Write and check the files of a release; raises NotReadyError."""
    version = check_versions(ROOT)
    if run("git", "status", "--porcelain"):
        raise NotReadyError("the checkout has changes that are not committed")
    folder.mkdir(parents=True, exist_ok=True)
    if any(folder.iterdir()):
        raise NotReadyError(f"{folder} is not empty")
    run(sys.executable, "-m", "hatchling", "build", "-d", str(folder.resolve()))
    source, wheel = next(folder.glob("*.tar.gz")), next(folder.glob("*.whl"))
    check_archives(source, wheel, version)
    if importlib.util.find_spec("twine"):
        run(sys.executable, "-m", "twine", "check", "--strict", str(source), str(wheel))
    sums = [
        f"{hashlib.sha256(file.read_bytes()).hexdigest()}  {file.name}" for file in (source, wheel)
    ]
    (folder / "SHA256SUMS").write_text("\n".join(sums) + "\n", encoding="utf-8")
    metadata = json.dumps(zenodo(read_citation(ROOT)), indent=1, ensure_ascii=False)
    (folder / "zenodo.json").write_text(metadata + "\n", encoding="utf-8")
    return [source, wheel]


def main() -> None:
    """Build a release."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("folder", type=Path, metavar="FOLDER")
    folder = parser.parse_args().folder
    try:
        source, wheel = release(folder)
    except NotReadyError as error:
        sys.exit(str(error))
    print(f"""\
{folder} is checked. To publish it, with accounts of your own:

git tag -a v{check_versions(ROOT)} && git push --tags
twine upload {source} {wheel}

A record with a DOI: make a deposit with zenodo.json, at Zenodo's address and with your token, put
both archives into the bucket that it answers with, check it on the site, and publish it there:

AUTH="Authorization: Bearer $TOKEN"
curl -H "$AUTH" --json @{folder / "zenodo.json"} $ZENODO/api/deposit/depositions
curl -H "$AUTH" -T {source} $BUCKET/{source.name}
curl -H "$AUTH" -T {wheel} $BUCKET/{wheel.name}

Then write the DOI into CITATION.cff.""")


if __name__ == "__main__":
    main()
