"""The onsets of a section, as scripts/section.py measures them."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "scripts"))
from measures.together import Together

sys.path.pop(0)
__all__ = ["Together"]
