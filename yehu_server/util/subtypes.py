"""Formats of samples in sound files, by the names that users give them."""

from typing import NamedTuple


class Subtype(NamedTuple):
    """A format of samples: bytes of one, libsndfile's name, the formats of files that have it."""

    size: int
    name: str
    files: tuple[str, ...]


SUBTYPES = {
    "16": Subtype(2, "PCM_16", ("wav", "flac")),
    "24": Subtype(3, "PCM_24", ("wav", "flac")),
    "float": Subtype(4, "FLOAT", ("wav",)),
}
FORMATS = ("wav", "flac")  # of files
DEFAULT_SUBTYPES = {"wav": "float", "flac": "24"}  # of recordings and replays
