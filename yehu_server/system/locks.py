"""Locks on files, which end with the process that holds them."""

import sys

if sys.platform == "win32":
    import msvcrt

    def lock(descriptor: int) -> None:
        """Lock an open file; raises BlockingIOError where another process holds it.

        Raises OSError where its disk has no locks.
        """
        try:
            msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)
        except PermissionError as error:
            raise BlockingIOError(*error.args) from error

    def unlock(descriptor: int) -> None:
        """Give up the lock, also where a fork has the file."""
        msvcrt.locking(descriptor, msvcrt.LK_UNLCK, 1)

else:
    import fcntl

    def lock(descriptor: int) -> None:
        """Lock an open file; raises BlockingIOError where another process holds it.

        Raises OSError where its disk has no locks.
        """
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)

    def unlock(descriptor: int) -> None:
        """Give up the lock, also where a fork has the file."""
        fcntl.flock(descriptor, fcntl.LOCK_UN)
