"""The player: turns MIDI messages, notes and mappings into moves of bow and fingers."""
