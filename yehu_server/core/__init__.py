"""All that is compiled: the model, bow and fingers, the player, MIDI, the stage, the callback."""
