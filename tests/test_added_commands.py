"""Commands of other packages of the project are found by an entry point."""

from pathlib import Path

import forks

import yehu_server
from yehu_lab.cli import COMMANDS as OF_LABORATORY
from yehu_server.cli import commands
from yehu_server.cli.commands import COMMANDS, all_commands, module_of


def test_both_tables_are_whole_and_in_the_order_of_the_help():
    found = all_commands()
    assert found.keys() == COMMANDS.keys() | OF_LABORATORY.keys()
    assert not COMMANDS.keys() & OF_LABORATORY.keys()
    first, *others = found
    assert first == "serve"
    assert others == sorted(others)
    for folder, table in (
        (Path(commands.__file__).parent, COMMANDS),
        (Path(*yehu_server.__path__).parent / "yehu_lab" / "cli", OF_LABORATORY),
    ):
        assert all((folder / f"{name}.py").exists() for name in table)


def test_a_command_of_the_server_looks_for_no_other(monkeypatch):
    monkeypatch.setattr(commands, "all_commands", None)
    assert module_of("render") == "yehu_server.cli.render"


def test_the_server_loads_nothing_of_the_laboratory():
    run = forks.run(
        code="import sys, yehu_server as yehu\n"
        "from yehu_server.cli import main\n"
        "import yehu_server.live.server, yehu_server.rendering.to_files\n"
        "yehu.render, yehu.simulate, yehu.Instrument, yehu.plot.level\n"
        "try: main(['render', '--help'])\n"
        "except SystemExit: pass\n"
        "print(*(name for name in sys.modules if name.startswith('yehu_lab')), sep=',')"
    )
    assert run.stdout.splitlines()[-1] == ""
