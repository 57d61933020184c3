"""Written scores: their notes and marks, how they are played, and their layout."""
