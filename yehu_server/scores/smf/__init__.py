"""Read Standard MIDI Files, damaged ones too."""
