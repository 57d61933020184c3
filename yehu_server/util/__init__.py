"""Files, sound files, documents and helper processes."""

from pathlib import Path

__version__ = "1.0.0"

PACKAGE = Path(__file__).parents[1]  # the folder of the whole package
