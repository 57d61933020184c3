"""The model of the paper: SI numbers and arrays; no note, no clock, no file, no MIDI."""
