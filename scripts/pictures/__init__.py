"""What `scripts/figures.py` draws, one subject a file."""
