"""Measuring sounds: how high they are and how loud. numpy only."""
