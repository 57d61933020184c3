"""Memory that processes share: by a descriptor that a child inherits; on Windows by its name."""

import mmap
import os
import secrets
import sys
import tempfile

Handle = tuple[int | str, int]  # what a child process opens it by, and its size (bytes)


class SharedMemory:
    """Zeroed memory, which child processes open by its handle.

    Raises OSError where there is not so much, or a limit on the size of files forbids it.

    `size`: in bytes.
    """

    def __init__(self, size: int) -> None:
        self.inherited: list[int] = []  # descriptors that a child has to inherit
        if sys.platform == "win32":
            name = f"yehu-server-{secrets.token_hex(16)}"
            self.handle: Handle = name, size
        else:
            descriptor = _descriptor()
            try:
                os.ftruncate(descriptor, size)
            except BaseException:
                os.close(descriptor)
                raise
            self.inherited.append(descriptor)
            self.handle = descriptor, size
        self.buffer = open_shared(self.handle)

    def close(self) -> None:
        """Let no more children open it; it is freed with the last process that has mapped it."""
        while self.inherited:
            os.close(self.inherited.pop())


def _descriptor() -> int:
    if sys.platform == "linux":
        return os.memfd_create("yehu-server")
    with tempfile.TemporaryFile() as file:
        return os.dup(file.fileno())


def open_shared(handle: Handle) -> mmap.mmap:
    """Map memory whose handle another process has sent."""
    place, size = handle
    if sys.platform == "win32":
        return mmap.mmap(-1, size, tagname=str(place))
    return mmap.mmap(int(place), size)


def map_all(memory: mmap.mmap) -> None:
    """Map each page in this process now, so that a real-time thread takes no page fault later."""
    memory[:: mmap.PAGESIZE]
