"""Read ABC, tunes in letters."""
