"""Follows a voice or a recording: what is heard of it, and the performance that this becomes."""
