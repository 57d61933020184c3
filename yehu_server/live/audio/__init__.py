"""Sound files and audio devices."""
