"""Read MusicXML."""
