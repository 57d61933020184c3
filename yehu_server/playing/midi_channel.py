"""The state of one MIDI channel: pedal, bend range, selected parameter and bank."""

from __future__ import annotations

from dataclasses import dataclass, field

from yehu_server.playing.wishes import Key

DATA_ENTRY, DATA_ENTRY_FINE = 6, 38
INCREMENT, DECREMENT = 96, 97
NRPN_FINE, NRPN, RPN_FINE, RPN = 98, 99, 100, 101


@dataclass
class Selected:
    """The registered or non-registered parameter that data entry sets."""

    is_registered: bool = True
    coarse: int | None = None  # None until received
    fine: int | None = None

    @property
    def number(self) -> tuple[int, int] | None:
        """Both halves of its number; None until both are received."""
        if self.coarse is None or self.fine is None:
            return None
        return self.coarse, self.fine


@dataclass
class MidiChannel:
    """What the messages on one channel have set up."""

    retriggered: dict[float, int] = field(default_factory=dict)  # held notes, and the frame
    bend_range: float | None = None  # semitones, once RPN 0 has set it
    sustain: bool = False
    # Keys released while the pedal is down, in that order: they end so.
    sustained: dict[Key, None] = field(default_factory=dict)
    selected: Selected = field(default_factory=Selected)
    bank: tuple[int, int] = (0, 0)

    def has_selected(self, registered: tuple[int, int]) -> bool:
        """Whether data entry sets a registered parameter, by its number."""
        return self.selected.is_registered and self.selected.number == registered

    def select(self, control: int, value: int) -> None:
        """Select a parameter by one half of its number; RPN and NRPN do not mix."""
        is_registered = control in (RPN, RPN_FINE)
        if self.selected.is_registered != is_registered:
            self.selected = Selected(is_registered)
        if control in (RPN, NRPN):
            self.selected.coarse = value
        else:
            self.selected.fine = value
