"""Play by a voice at an audio input, which is followed as it sings (``core.voice``)."""

import math
import threading
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from yehu_server.core.physics.elementary import log2
from yehu_server.core.voice.note_detection import VOICE_CHANNEL, VOICE_KEYS, ends_of
from yehu_server.live.audio.devices import INPUT
from yehu_server.live.audio.output import OutputOptions
from yehu_server.playing.options import AS_IT_SINGS, PlayingOptions
from yehu_server.playing.part_state import Key
from yehu_server.playing.player import Player
from yehu_server.playing.tuning import KEYS, STANDARD_A4
from yehu_server.system.memory import SharedMemory
from yehu_server.util.processes import Child, Message, Supervisor

ADVICE = "wear headphones, or it follows itself"


@dataclass
class FollowOptions:
    """The input to follow; see ``yehu-server serve --help``."""

    device: str | None = None  # None: the system's default
    transpose: float | None = None  # semitones; None: by octaves, as the first note wants
    correct: float = 0.0  # how far what is played is moved to the tuning, 0 to 1


def tuned_as(playing: PlayingOptions) -> dict[str, Any]:
    """The fields of a follower for a tuning and a reference pitch."""
    a4 = playing.a4
    pitches = [playing.tuning.pitch(key, a4) for key in KEYS]
    return {
        "a4_offset": 12.0 * log2(STANDARD_A4 / a4),
        "tuning": [math.nan if pitch is None else pitch for pitch in pitches],
    }


class VoiceInput(Supervisor):
    """Plays the first part by an audio input, in a process; reports its loss to `on_message`."""

    def __init__(
        self,
        player: Player,
        options: FollowOptions,
        playing: PlayingOptions,
        output: OutputOptions,
        memory: SharedMemory,
        on_message: Callable[[str], None],
    ) -> None:
        module = "yehu_server.live.audio.stream"
        super().__init__(module, "voice", on_message, memory.inherited)
        self._player, self._options = player, options
        self._output, self._memory = output, memory
        self._fields = ends_of(player.notes) | tuned_as(playing)
        self._child: Child | None = None
        self._name = ""
        self._problem = ""

    def start(self) -> None:
        """Start to follow."""
        for address, value in AS_IT_SINGS.items():
            self._player.set(address, value, frame=self._player.frame_of())
        super().start()

    def attend(self, child: Child, gone: threading.Event) -> None:
        """See `Supervisor`."""
        self._child = child
        child.send("search", kind=INPUT, device=self._options.device)
        gone.wait()

    def on_event(self, event: Message) -> None:
        """See `Supervisor`."""
        kind, child, options = event["event"], self._child, self._options
        if child is None:
            return
        if kind == "found":
            self._name = event["name"]
            child.send(
                "open",
                kind=INPUT,
                memory=self._memory.handle,
                rate=event["rate"],
                blocksize=self._output.blocksize,
                latency=self._output.latency,
                channels=1,
                transpose=math.nan if options.transpose is None else options.transpose,
                correct=options.correct,
                fields=self._fields,
            )
        elif kind == "ready":
            child.send("start")
        elif kind == "started":
            self._problem = ""
            self._on_message(f"following {self._name}: {ADVICE}")
        elif kind in ("missing", "failed") and event["reason"] != self._problem:
            self._problem = event["reason"]
            self._on_message(f"no voice to follow: {self._problem}")

    def on_exit(self, *, by_itself: bool) -> None:
        """End the note that the input has begun."""
        player, name = self._player, self._name
        self._child, self._name = None, ""
        keys = [Key(VOICE_CHANNEL, key) for key in VOICE_KEYS]
        player.end_keys(keys, frame=player.frame_of())
        if by_itself and name:
            self._on_message(f"{name} is gone; it is followed again once it is back")
