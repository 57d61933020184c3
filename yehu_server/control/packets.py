"""OSC packets taken apart: messages with their time tags; and messages put together."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from pythonosc.osc_bundle import OscBundle
from pythonosc.osc_message import OscMessage
from pythonosc.osc_message_builder import OscMessageBuilder
from pythonosc.parsing.osc_types import IMMEDIATELY

DEEPEST = 32  # bundles in bundles


class PacketError(ValueError):
    """Bytes that are no OSC packet."""


@dataclass(frozen=True)
class Message:
    """One OSC message.

    `due_s` is the time its bundle asks for, in seconds since 1970, or None for now.
    """

    address: str
    arguments: Sequence[Any]
    due_s: float | None = None


def unpack(packet: bytes) -> list[Message]:
    """The messages of a packet, in order. Errors: PacketError; nothing of it counts then."""
    try:
        if OscBundle.dgram_is_bundle(packet):
            return list(_in_bundle(OscBundle(packet), None, DEEPEST))
        if OscMessage.dgram_is_message(packet):
            return [_message(OscMessage(packet), None)]
    # python-osc lets whatever its parsing meets through: IndexError, struct.error,
    # UnicodeDecodeError, RecursionError.
    except Exception as error:
        raise PacketError(str(error)) from error
    raise PacketError("neither a message nor a bundle")


def _in_bundle(bundle: OscBundle, due_s: float | None, depth: int) -> Iterator[Message]:
    if depth == 0:
        raise PacketError("bundles too deep in bundles")
    if bundle.timestamp != IMMEDIATELY:
        due_s = bundle.timestamp
    for content in bundle:
        if isinstance(content, OscBundle):
            yield from _in_bundle(content, due_s, depth - 1)
        else:
            yield _message(content, due_s)


def _message(message: OscMessage, due_s: float | None) -> Message:
    return Message(message.address, message.params, due_s)


def pack(address: str, *arguments: float | str | bool) -> bytes:
    """One message as a packet."""
    builder = OscMessageBuilder(address)
    for argument in arguments:
        builder.add_arg(argument)
    return builder.build().dgram
