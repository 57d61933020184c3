"""Bind the next control that you move to a parameter of a running server.

  yehu-server learn vibrato
  yehu-server learn --soft /playing/pressure /playing/bow_position
  yehu-server learn --only /playing/vibrato
  yehu-server learn
  yehu-server learn --forget /playing/vibrato
  yehu-server learn --part 2 /playing/vibrato

Start `yehu-server serve` first. Each binding is saved at once, in a mapping file of your own.
"""

from __future__ import annotations

import argparse
import contextlib
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from yehu_server.cli.arguments import add_command, add_options, add_server, server_of
from yehu_server.cli.converters import positive
from yehu_server.cli.terminal import print_result, warn
from yehu_server.errors import ParameterError, YehuError
from yehu_server.live.part_addresses import group_of
from yehu_server.params.table import PREFIX, TABLE
from yehu_server.system.terminals import complete_by
from yehu_server.util.hints import shown_path

if TYPE_CHECKING:
    from yehu_server.live.osc.command_client import OscClient

LONGEST_S = 60.0


def add_to(commands: Any) -> None:
    """Add the command to the parser."""
    parser = add_command(commands, "learn", __doc__, run)
    add_options(
        parser,
        """
        parameters ADDRESS: the parameters, such as vibrato; without any, the command asks for them
        --soft: soft take-over: the knob has no effect until it reaches the present value
        --only: take the parameter away from all other controls, until --forget
        --forget: remove what was learned for these parameters, and give back what it took
        --part N: the part (player) whose parameter it is, counted from 1 (default: 1)
        """,
        parameters={"nargs": "*"},
        part=positive,
    )
    add_server(parser)


def run(arguments: argparse.Namespace) -> int:
    """Run the command; return its exit code."""
    from yehu_server.live.osc.command_client import OscClient

    with OscClient(server_of(arguments)) as client:
        if arguments.parameters:
            for address in arguments.parameters:
                _one(client, address, arguments)
        else:
            _ask(client, arguments)
    return 0


def _one(client: OscClient, address: str, arguments: argparse.Namespace) -> None:
    own = "" if arguments.part is None else group_of(arguments.part - 1)
    if arguments.forget:
        client.send(f"{own}/unlearn", address)
        _, count, *returned = client.answer(f"{own}/unlearned").arguments
        print_result(f"{address}: {count} forgotten")
        _print_binds(returned, "again")
        return
    client.send(f"{own}/learn", address, int(arguments.soft), int(arguments.only))
    target = client.answer(f"{own}/learning").arguments[0].removeprefix(PREFIX)
    print_result(f"move the control for {target} ... (Ctrl-C ends)", flush=True)
    try:
        for message in client.answers(LONGEST_S):
            if message.address == f"{own}/learned":
                _, source, file, others, *lost = message.arguments
                print_result(f"{source} added: {target}, saved in {shown_path(Path(file))}")
                if others:
                    print_result(f"  {others} still move{'s' * (', ' not in others)} it, too")
                _print_binds(lost, "no longer, until --forget")
                return
            if message.address == f"{own}/learning":
                raise ParameterError("something else is learned now; nothing was moved for this")
    except KeyboardInterrupt:
        client.send(f"{own}/learn")
        raise
    client.send(f"{own}/learn")
    raise ParameterError(f"nothing was moved for {LONGEST_S:g} s")


def _print_binds(words: list[str], what: str) -> None:
    """Print binds that are gone or back: their sources and targets, one after another."""
    for source, target in zip(words[::2], words[1::2], strict=True):
        print_result(f"  {source} moves {target.removeprefix(PREFIX)} {what}")


def _ask(client: OscClient, arguments: argparse.Namespace) -> None:
    """Ask for parameters until an empty line, or the end of input (Ctrl-D)."""
    if not sys.stdin.isatty():
        raise ParameterError("name the parameters to learn, such as /playing/vibrato")
    _complete()
    with contextlib.suppress(EOFError):
        while address := input("parameter (Tab completes, an empty line ends): ").strip():
            try:
                _one(client, address, arguments)
            except YehuError as error:
                warn(str(error))


def _complete() -> None:
    addresses = [param.address for param in TABLE if not param.player_controlled]

    def complete(text: str, state: int) -> str | None:
        fitting = [address for address in addresses if address.startswith(text)]
        return fitting[state] if state < len(fitting) else None

    complete_by(complete)
