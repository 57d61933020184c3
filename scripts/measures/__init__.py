"""What `scripts/playability.py` measures, one subject a file."""
