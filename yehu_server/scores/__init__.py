"""Files of performances: Standard MIDI Files, captured sessions, gestures."""
