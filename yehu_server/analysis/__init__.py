"""Measures pitch and level of sounds. Needs numpy only."""
