"""The OSC calls that load, save, delete and list presets, and morph between two."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial

from yehu_server.errors import PresetError, shortened
from yehu_server.live.osc.call import NAME, Argument, CountError, Request, osc_call
from yehu_server.live.osc.context import GroupCalls
from yehu_server.live.part_addresses import OF_PARTS
from yehu_server.params.preset_file import Preset, morph
from yehu_server.params.table import PREFIX
from yehu_server.playing.preset_folders import Presets

PRESET, FROM, TO = Argument("preset", "s"), Argument("from", "s"), Argument("to", "s")
PRESETS = frozenset((PRESET, FROM, TO))  # of which there are only some
AMOUNT = Argument("amount", lo=0.0, hi=1.0)


class PresetCalls(GroupCalls):
    """Carries out the calls under ``/preset``."""

    @property
    def _presets(self) -> Presets:
        return self._player.presets

    @osc_call("/preset/load", "Sets the parameters of a preset.", PRESET, reads_files=True)
    def _load(self, call: Request) -> None:
        preset = self._presets.load(call.word())
        self._set(call, "/preset/load", preset.values)
        self._send(call.peer, "/preset/loaded", preset.name)
        for remark in preset.remarks():
            self._send_error(call.peer, "/preset/load", remark)

    def _set(self, call: Request, address: str, values: Mapping[str, float]) -> None:
        """Set values of presets, but those that all parts share in the first part alone."""
        shared = [one for one in values if self._player.part > 0 and one not in OF_PARTS]
        own = {one: value for one, value in values.items() if one not in shared}
        self._player.load(own, frame=call.frame)
        self._echo(call.peer, own)
        if kept := [one for one in own if address == "/preset/load" and self._player.keeps(one)]:
            held = f"{', '.join(kept)}: held by --set, left out; {self._prefix}/release frees it"
            self._send_error(call.peer, address, held)
        if shared:
            which = f"{', '.join(shared)}: one for all parts, left out; "
            self._send_error(call.peer, address, f"{which}{PREFIX}{address} sets what all share")

    @osc_call(
        "/preset/morph",
        "Sets values between those of two presets.",
        FROM,
        TO,
        AMOUNT,
        reads_files=True,
    )
    def _morph(self, call: Request) -> None:
        if [isinstance(each, str) for each in call.arguments] != [True, True, False]:
            raise CountError("expected two names and a number from 0 to 1")
        (amount,) = call.numbers(1, after=2)
        if not 0.0 <= amount <= 1.0:
            raise PresetError(f"AMOUNT: {amount:g} is not within 0 to 1")
        one, other = self._named(call, 0), self._named(call, 1)
        self._set(call, "/preset/morph", morph(one, other, amount))

    def _named(self, call: Request, place: int) -> Preset:
        return self._presets.load(replace(call, arguments=call.arguments[place:][:1]).word())

    @osc_call("/preset/save", "Saves the parameters as a preset.", NAME)
    def _save(self, call: Request) -> None:
        name = call.word()
        self._check_rate()
        sound = self._player.sound()

        def save() -> Callable[[], None]:
            self._presets.save(name, sound)
            return partial(self._announce, call, "/preset/saved", name)

        self._write(call.peer, "/preset/save", save)

    def _announce(self, call: Request, answer: str, name: str) -> None:
        """Answer, and announce that there are other presets."""
        self._player.know_programs()
        self._context.announce("/preset")
        self._send(call.peer, answer, name)

    @osc_call("/preset/delete", "Removes a preset of the player's own.", NAME, is_for_all=True)
    def _delete(self, call: Request) -> None:
        name = call.word()

        def delete() -> Callable[[], None]:
            self._presets.delete(name)
            return partial(self._announce, call, "/preset/deleted", name)

        self._write(call.peer, "/preset/delete", delete)

    @osc_call(
        "/preset/list",
        "Sends all presets and rooms: name, MIDI program, description.",
        is_for_all=True,
        reads_files=True,
    )
    def _list(self, call: Request) -> None:
        presets, errors = self._presets.all()
        for preset in presets:
            row = (preset.name, preset.program or 0, shortened(preset.about))
            self._send(call.peer, "/preset/room" if preset.is_room else "/preset", *row)
        self._send(call.peer, "/presets", len(presets))
        for error in errors:
            self._send_error(call.peer, "/preset/list", str(error))
