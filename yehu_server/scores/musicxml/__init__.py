"""Read and write MusicXML."""
