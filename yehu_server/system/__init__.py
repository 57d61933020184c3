"""What differs between Linux, macOS and Windows: clocks, memory, locks, processes, sockets, files.

Each module has the forms of all systems side by side. No other module asks which system it is on.
"""

import sys

NAME = {"win32": "windows", "darwin": "macos"}.get(sys.platform, "linux")
