"""Draw networks of boxes and cords from text, for the patches of Max and Pure Data."""

import re
from abc import ABC, abstractmethod
from typing import Generic, TypeVar

from yehu_server.surfaces.common_layout import local_name, osc_address

# While a control is moved it ignores the server, whose echo would move it back.
QUIET_MS = 250
LEFT, ROW, GAP = 16, 30, 24
CHARACTER, MAX_CHARACTERS = 7, 60  # of a box: its width, and where its text is wrapped
BOX = re.compile(r"(?:(\d):)?(\w*)(?:\[(.*)([](]))?(?::(\d))?", re.DOTALL)

Box = TypeVar("Box")


class Network(ABC, Generic[Box]):
    """A patch to draw on; the boxes of a line of text lie in a row, from `top` on."""

    def __init__(self, top: float) -> None:
        self._boxes: dict[str, Box] = {}
        self._bottom = top

    @abstractmethod
    def box(self, text: str, x: float, y: float, *, is_message: bool) -> Box:
        """Add an object or a message."""

    @abstractmethod
    def cord(self, source: Box, outlet: int, target: Box, inlet: int) -> None:
        """Connect an outlet to an inlet."""

    @abstractmethod
    def prefixing(self, address: str) -> str:
        """Return the text of an object that sends its input to an OSC address."""

    def draw(self, text: str, **boxes: Box) -> None:
        """Add what a text draws, line by line: ``clock[metro 500] -> [1( -> 1:gate``.

        ``[metro 500]`` is an object, ``[1(`` a message. A name before the bracket keeps it for
        later lines, and later texts; ``1:gate`` is the second inlet of such a box, ``order:1`` its
        second outlet. `boxes` are others that the text may name. ``[@/note]`` sends its input to
        the call /note, and ``~out`` is a name of this part's patch, see `local_name`.
        """
        text = re.sub(r"~(\w+)", lambda found: local_name(found[1]), text)
        text = re.sub(r"@(/[\w/]+)", lambda found: self.prefixing(osc_address(found[1])), text)
        self._boxes |= boxes
        for line in text.strip().splitlines():
            x, before = float(LEFT), None
            for word in line.strip().split(" -> "):
                found = BOX.fullmatch(word)
                if found is None:
                    raise ValueError(f"not a box: {word}")
                inlet, name, content, end, outlet = found.groups()
                if content is not None:
                    is_message = end == "("
                    self._boxes[name] = self.box(content, x, self._bottom, is_message=is_message)
                    x += width_of(content) + GAP
                box = self._boxes[name]
                if before is not None:
                    self.cord(*before, box, int(inlet or 0))
                before = box, int(outlet or 0)
            self._bottom += ROW if x > LEFT else 0


def width_of(text: str) -> int:
    """The width of a box (points), by its text."""
    return CHARACTER * max(6, min(len(text) + 2, MAX_CHARACTERS))
