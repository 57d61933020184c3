"""The process that serves pages."""

import contextlib
import socket
from types import SimpleNamespace
from unittest.mock import Mock

import pytest

from yehu_server.core.player.note_range import YEHU
from yehu_server.live.page import process


def test_the_module_is_looked_for_and_compiled_only_once_a_page_is_opened(monkeypatch):
    child = Mock()
    monkeypatch.setattr(process, "Child", child)
    for name in ("SharedView", "PageSockets", "check"):
        monkeypatch.setattr(process, name, Mock())
    monkeypatch.setattr(process.asyncio, "SelectorEventLoop", Mock())
    order = {
        "socket": socket.socket().detach(),
        "allowed": [],
        "guests": None,
        "open_notes": YEHU.open_notes,
        "reaches": YEHU.reaches,
        "memory": (0, 1),
        "rigs": [0],
    }
    pages = process.Pages(order)
    assert not child.called

    async def open_page() -> int:
        return (await pages._respond(SimpleNamespace(path="/", headers={}))).status

    for _ in range(2):
        with contextlib.closing(open_page()) as opening, pytest.raises(StopIteration) as ended:
            opening.send(None)
        assert ended.value.value == 200
    pages._listening.close()
    assert [call.args[0] for call in child.call_args_list] == [
        "yehu_server.live.page.module_process"
    ]
