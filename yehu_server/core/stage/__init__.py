"""The stage, compiled: where players sit, the room about them, and the mix of all to two channels.

It knows signals, metres and seconds: no note, no player, no file.
"""
