"""Make the parts of a release into a folder, one after another, and try the wheel."""

import argparse
import json
import sys
import time
from collections.abc import Callable
from pathlib import Path

from releases import parts, trials
from releases.citation import NotReadyError, check_versions, read_citation, zenodo
from yehu_server.errors import YehuError

ROOT = parts.ROOT


def deposit(folder: Path, _version: str) -> list[Path]:
    """CITATION.cff as the metadata of a deposit, which is archived with a DOI."""
    metadata = json.dumps(zenodo(read_citation(ROOT)), indent=1, ensure_ascii=False)
    path = folder / "zenodo.json"
    path.write_text(metadata + "\n", encoding="utf-8")
    return [path]


# In the order in which they are made: the sums are last.
PARTS: dict[str, Callable[[Path, str], list[Path]]] = {
    "archives": parts.archives,
    "page": parts.page,
    "plug-ins": parts.plugins,
    "site": parts.site,
    "licences": parts.licences,
    "deposit": deposit,
    "sums": parts.sums,
}
UPLOAD = """
To publish what is in {folder}, with accounts of your own:

git tag -a v{version} && git push --tags
twine upload {folder}/*.whl {folder}/*.tar.gz

A record with a DOI: make a deposit with zenodo.json, at Zenodo's address and with your token, put
the files into the bucket that it answers with, check it on the site, and publish it there:

AUTH="Authorization: Bearer $TOKEN"
curl -H "$AUTH" --json @{folder}/zenodo.json $ZENODO/api/deposit/depositions
curl -H "$AUTH" -T FILE $BUCKET/FILE

Then write the DOI into CITATION.cff."""


def make(folder: Path, version: str, wanted: list[str]) -> list[str]:
    """Make parts; return those that could not be made, with why."""
    missing = []
    for name in (name for name in PARTS if name in wanted):
        began = time.monotonic()
        try:
            files = PARTS[name](folder, version)
        except (NotReadyError, YehuError) as error:
            missing.append(f"{name}: not made: {error}")
            print(missing[-1], flush=True)
            continue
        took = time.monotonic() - began
        for file in files:
            print(f"{name}: {file} ({file.stat().st_size / 1e6:.2f} MB)", flush=True)
        print(f"{name}: {took:.0f} s", flush=True)
    return missing


def main() -> int:
    """Make a release; return the exit code."""
    parser = argparse.ArgumentParser(prog="scripts/release", description=__doc__)
    parser.add_argument("-o", metavar="FOLDER", type=Path, default=ROOT / "dist", dest="folder")
    parser.add_argument("--only", metavar="PART", nargs="+", choices=PARTS, default=list(PARTS))
    parser.add_argument("--no-trial", action="store_true", help="make it, and try nothing")
    arguments = parser.parse_args()
    folder: Path = arguments.folder
    try:
        version = check_versions(ROOT)
        changed = parts.run("git", "status", "--porcelain")
    except NotReadyError as error:
        sys.exit(str(error))
    if changed:
        sys.exit("the checkout has changes that are not committed")
    if folder.exists() and any(folder.iterdir()) and arguments.only == list(PARTS):
        sys.exit(f"{folder} is not empty")
    folder.mkdir(parents=True, exist_ok=True)
    missing = make(folder, version, arguments.only)
    failed = 0 if arguments.no_trial else trials.main(list(map(str, folder.glob("*.whl"))))
    if missing or failed:
        print("\nThe release is not whole:", *missing, sep="\n")
        return 1
    print(UPLOAD.format(folder=folder, version=version))
    return 0


if __name__ == "__main__":
    sys.exit(main())
