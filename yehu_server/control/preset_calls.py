"""The OSC calls that load, save, delete and list presets, and morph between two."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace

from yehu_server.control.allowance import Allowance
from yehu_server.control.clients import Clients
from yehu_server.control.packets import pack
from yehu_server.control.peers import Peer
from yehu_server.control.request import Desk, Request
from yehu_server.errors import PresetError
from yehu_server.lines import shortened
from yehu_server.params.preset import Preset, morph
from yehu_server.playing.live import LivePlayer

SAVES_A_SECOND, SAVES_AT_ONCE = 1.0, 10.0  # of all clients together: each writes a file


class PresetCalls:
    """Carries out the calls under ``/preset``.

    Parameters
    ----------
    complain : callable
        Sends a peer an error that stops nothing, with the address that it sent to.

    Attributes
    ----------
    by_address : dict
        The function that carries out each call; each raises YehuError where it refuses.
    """

    def __init__(
        self,
        player: LivePlayer,
        clients: Clients,
        complain: Callable[[Peer, str, str], None],
        desk: Desk,
    ) -> None:
        self._player = player
        self._presets = player.presets
        self._clients = clients
        self._complain = complain
        self._desk = desk
        self._prefix = clients.prefix
        self._saves = Allowance(SAVES_A_SECOND, SAVES_AT_ONCE)
        self.by_address: dict[str, Callable[[Request], None]] = {
            "/preset/load": self._load,
            "/preset/morph": self._morph,
            "/preset/save": self._save,
            "/preset/delete": self._delete,
            "/preset/list": self._list,
        }

    def _load(self, call: Request) -> None:
        preset = self._presets.load(call.word())
        self._player.load(preset.values, frame=call.frame)
        self._clients.echo(call.peer, preset.values)
        call.peer.send(pack(f"{self._prefix}/preset/loaded", preset.name))
        for remark in preset.remarks():
            self._complain(call.peer, f"{self._prefix}/preset/load", remark)

    def _morph(self, call: Request) -> None:
        if len(call.arguments) != 3:
            raise PresetError("expected two names and a number from 0 to 1")
        one, other = self._named(call, 0), self._named(call, 1)
        (amount,) = replace(call, arguments=call.arguments[2:]).numbers(1)
        values = morph(one, other, amount)
        self._player.load(values, frame=call.frame)
        self._clients.echo(call.peer, values)

    def _named(self, call: Request, place: int) -> Preset:
        return self._presets.load(replace(call, arguments=call.arguments[place:][:1]).word())

    def _save(self, call: Request) -> None:
        name = call.word()
        if not self._saves.takes(time.monotonic()):
            raise PresetError("presets are saved too often; try again in a second")
        self._presets.save(name, self._player.sound())
        self._desk.tree_changed(f"{self._prefix}/preset")
        call.peer.send(pack(f"{self._prefix}/preset/saved", name))

    def _delete(self, call: Request) -> None:
        name = call.word()
        self._presets.delete(name)
        self._desk.tree_changed(f"{self._prefix}/preset")
        call.peer.send(pack(f"{self._prefix}/preset/deleted", name))

    def _list(self, call: Request) -> None:
        presets, errors = self._presets.all()
        for preset in presets:
            row = (preset.name, preset.program or 0, shortened(preset.about))
            call.peer.send(pack(f"{self._prefix}/preset", *row))
        call.peer.send(pack(f"{self._prefix}/presets", len(presets)))
        for error in errors:
            self._complain(call.peer, f"{self._prefix}/preset/list", str(error))
