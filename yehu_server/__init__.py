"""A virtual yehu: its strings, bow, finger and body simulated, played by MIDI and OSC."""

__version__ = "0.1.0"
