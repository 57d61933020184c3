"""The model alone: a gesture in physical units becomes arrays of every signal."""
