"""What differs between systems: clocks, memory, locks, processes, sockets, files."""

import sys

NAME = {"win32": "windows", "darwin": "macos"}.get(sys.platform, "linux")
