"""Events: all that a part can be sent, each at a frame.

A command (``player.commands``) may also be posted as an event, as a replay does; it passes on to
the players of the part. Beside them:

| kind | index | value | other |
|---|---|---|---|
| MESSAGE | a MIDI message: ``midi.packing.packed`` | | |
| NOTE_ON | channel, or below 0 for none | key | velocity (0 to 1); below 0: it has its values |
| FINGER_ON | the same; for a pitch, whatever the tuning | pitch | velocity |
| NOTE_OFF | the channel of the note | its key | |
| SET | index of a parameter | value, until a controller moves it | least time of the moves (ms) |
| LOAD | index of a parameter | value of a preset, unless it is held | |
| CONTROL | number of a named control of the mapping | its argument | |
| DISCONNECT | port that is gone | | |
| LEAVE | first of the channels of somebody who left | how many channels | |
| RELEASE_ALL | | 0: all notes end; 1: pedals, zones and moves, too, are forgotten | |
| START | | 0: start values of tables; 1: first of all parameters | |
| TABLES_TO | number of the tables to use from now on | | |
"""

from yehu_server.core.player.commands import KINDS

EVENTS = (
    "message", "note_on", "finger_on", "note_off", "set", "load", "control", "disconnect", "leave",
    "release_all", "start", "tables_to",
)  # fmt: skip
(
    MESSAGE, NOTE_ON, FINGER_ON, NOTE_OFF, SET, LOAD, CONTROL, DISCONNECT, LEAVE, RELEASE_ALL,
    START, TABLES_TO,
) = range(len(KINDS), len(KINDS) + len(EVENTS))  # fmt: skip
