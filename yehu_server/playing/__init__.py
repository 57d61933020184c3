"""Decisions a player makes: from MIDI messages and notes to what bow and finger shall do."""
