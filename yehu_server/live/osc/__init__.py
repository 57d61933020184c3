"""How people reach the instrument live: OSC and MIDI."""
