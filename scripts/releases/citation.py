"""What a release says of itself: its version, in all files alike, and the metadata of a deposit."""

import re
import tomllib
from pathlib import Path
from typing import Any

import yaml


class NotReadyError(Exception):
    """What stands in the way of a release, or of a part of it."""


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
