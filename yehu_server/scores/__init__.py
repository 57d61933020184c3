"""Files of performances: MIDI, MusicXML, ABC, jianpu, captures, ensembles, gestures."""
