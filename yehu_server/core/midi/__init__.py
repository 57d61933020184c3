"""What MIDI messages and named controls mean: events go in, commands come out. Compiled.

A part has one record (`record.MIDI`), whatever plays it: one instrument, or those of a section.
What files say (a mapping, a tuning, presets by program) lies in flat tables (`tables.TABLES`).
"""
