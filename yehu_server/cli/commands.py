"""What commands there are: those of this package, and those that others of the project add.

A package adds its own by an entry point of GROUP, which names its table of them.
"""

# What each command is for; each is a module of this package.
COMMANDS = {
    "serve": "play live, by MIDI and OSC",
    "build": "compile the instrument: a plug-in for DAWs, a module for web pages, a C library",
    "devices": "list audio outputs, audio inputs and MIDI inputs",
    "follow": "play the tune of a voice or an instrument in a sound file",
    "learn": "bind a knob, pedal or OSC address to a parameter of a running server",
    "mappings": "list, show, check and convert mappings: what controllers move",
    "page": "show the instrument as a web page, which plays without a server",
    "presets": "list, show and check presets",
    "render": "render scores to a sound file, or a folder of scores to a folder",
    "replay": "render a session that serve --capture wrote to a sound file",
    "score": "show how a score is read, or write it as MusicXML or jianpu",
    "simulate": "run the model with given motions of bow and finger; keep all signals",
    "surfaces": "write control surfaces for TouchOSC, Max, Pure Data, Open Stage Control",
}
FIRST = "serve"  # in the help; the others follow by their names
GROUP = "yehu_server.commands"


def all_commands() -> dict[str, tuple[str, str]]:
    """Each command's module and what it is for, in the order of the help."""
    from importlib.metadata import entry_points  # 10 ms, which few commands need

    found = {name: (f"{__package__}.{name}", text) for name, text in COMMANDS.items()}
    for point in entry_points(group=GROUP):
        found |= {name: (f"{point.module}.{name}", text) for name, text in point.load().items()}
    return dict(sorted(found.items(), key=lambda each: (each[0] != FIRST, each[0])))


def module_of(name: str) -> str | None:
    """The module of a command, or None where there is none; others are not searched first."""
    if name in COMMANDS:
        return f"{__package__}.{name}"
    return all_commands().get(name, (None,))[0]
