"""What MIDI messages, mappings, presets and tunings mean: wishes of the player."""
