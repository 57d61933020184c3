"""The player: turns commands into moves of bow and fingers, in the audio callback. Compiled."""
