"""MIDI inputs, as they come and go; which plays which part."""
