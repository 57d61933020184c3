"""Write the generated modules of the page to a folder: ``python -m yehu_server.live.page web``."""

import sys
from pathlib import Path

from yehu_server.live.page.facts import write

if __name__ == "__main__":
    write(Path(sys.argv[1]))
