"""Performances as files: Standard MIDI Files now, captured sessions next."""
