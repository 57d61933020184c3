"""Practising: how each note of an instrument is best bowed, found by playing it."""
