"""Formats of samples in sound files, by the names that users give them."""

from typing import NamedTuple


class Subtype(NamedTuple):
    """A format of samples: bytes of one, libsndfile's name, the formats that have it."""

    size: int
    name: str
    files: tuple[str, ...]


SUBTYPES = {
    "16": Subtype(2, "PCM_16", ("wav", "flac", "raw")),
    "24": Subtype(3, "PCM_24", ("wav", "flac", "raw")),
    "float": Subtype(4, "FLOAT", ("wav", "raw")),
}
FORMATS = ("wav", "flac")  # of files
DEFAULT_SUBTYPES = {"wav": "float", "flac": "24"}  # of recordings and replays
