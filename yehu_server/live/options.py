"""Options of a live server, and of each of its parts."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from platformdirs import user_music_path

from yehu_server.live.audio.output import OutputOptions
from yehu_server.live.audio.voice_input import FollowOptions
from yehu_server.live.midi.midi_inputs import MidiOptions
from yehu_server.live.network import OSC_ADDRESS, Address, Allowed
from yehu_server.live.page.pages import PageOptions
from yehu_server.live.web.server import WebOptions
from yehu_server.playing.mapping import Mapping
from yehu_server.playing.options import PlayingOptions


@dataclass
class PartOptions:
    """Options of one part."""

    playing: PlayingOptions = field(default_factory=PlayingOptions)
    reread: Callable[[], Mapping] | None = (
        None  # reads the mapping's files; None: they are not watched
    )


@dataclass
class ServeOptions:
    """Options of a server; see ``yehu-server serve --help``."""

    output: OutputOptions = field(default_factory=OutputOptions)
    midi: MidiOptions | None = field(default_factory=MidiOptions)  # None: no MIDI
    follow: FollowOptions | None = None  # None: no voice is followed
    osc: Address = OSC_ADDRESS
    allowed: Allowed = field(default_factory=Allowed)
    http: WebOptions | None = None  # None: no OSCQuery
    page: PageOptions | None = None  # None: no page
    announce: bool | None = None  # None: what other machines can reach
    parts: Sequence[PartOptions] = field(default_factory=lambda: [PartOptions()])
    has_room: bool = True
    jitter_ms: float | None = None  # None: see playing.delay
    record: Path | None = None
    waits_for_sound: bool = False  # whether the recording begins with the first sound
    capture: Path | None = None
    overwrite: bool = False  # whether these two may replace older files
    recordings: Path = field(default_factory=lambda: user_music_path() / "yehu-server")
