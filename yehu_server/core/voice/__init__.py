"""Follows a voice as it sings: its pitch, its notes, and the commands they become. Compiled."""
