"""Makes what pages need to compute the sound themselves, which may take a minute.

The process of its own has the lowest priority: it must not disturb whoever plays meanwhile.
"""

import tempfile
from pathlib import Path

from yehu_server.ahead.build import page_module
from yehu_server.errors import YehuError
from yehu_server.live.page.examples import write_capture_headers
from yehu_server.system.processes import LOWEST, lower_priority
from yehu_server.util.processes import Parent


def main() -> None:
    """Send the parent process small files, and then the module's path or why there is none."""
    parent = Parent()
    lower_priority(LOWEST)
    try:
        with tempfile.TemporaryDirectory(prefix="yehu-page-") as folder:
            for file in write_capture_headers(Path(folder)):
                parent.send("beginning", name=file.name, text=file.read_text("utf-8"))
        path = page_module()
    except (YehuError, OSError) as error:
        parent.send("none", reason=str(error))
    else:
        parent.send("module", path=str(path))


if __name__ == "__main__":
    main()
