"""The instrument as a running thing: compiled gestures, the model, the output."""
