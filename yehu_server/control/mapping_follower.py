"""Take up a mapping again when its files change while it is played."""

from __future__ import annotations

import time
from collections.abc import Callable

from yehu_server.errors import MappingError
from yehu_server.playing.live import LivePlayer
from yehu_server.playing.mapping import Mapping
from yehu_server.playing.mapping_watch import MappingWatch

LOOK_EVERY_S = 0.5


class MappingFollower:
    """Watches a mapping's files, and gives the player the new mapping where they are right.

    Parameters
    ----------
    reread : callable
        Reads the files. Raises MappingError.
    changed : callable
        Called when the player has got a new mapping.
    said : callable
        Called with a line about each change, and about what is wrong with the files.
    """

    def __init__(
        self,
        player: LivePlayer,
        reread: Callable[[], Mapping],
        changed: Callable[[], None],
        said: Callable[[str], None],
    ) -> None:
        self._player = player
        self._watch = MappingWatch(player.mapping, reread)
        self._changed = changed
        self._said = said
        self._next_look = 0.0  # monotonic s

    def look(self) -> None:
        """Look at the files, at most every LOOK_EVERY_S."""
        if time.monotonic() < self._next_look:
            return
        self._next_look = time.monotonic() + LOOK_EVERY_S
        try:
            mapping = self._watch.look()
        except MappingError as error:
            self._said(f"{error}; the mapping stays as it was")
            return
        if mapping is not None:
            self._player.remap(mapping, frame=self._player.frame_of())
            self._changed()
            self._said(f"the mapping {mapping.name} has changed; it is used from now on")
