"""Files of performances: MIDI files, MusicXML, jianpu, captures, ensembles, gestures."""
