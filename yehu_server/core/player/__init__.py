"""The player: turns commands (notes, parameters) into moves of bow and fingers. Compiled.

It runs in the audio callback, on one flat record (``record.PLAYER``) beside the controls.
"""
