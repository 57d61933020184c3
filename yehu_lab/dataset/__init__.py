"""Labelled sounds for learners: drawn by chance from a description, and made of it again alike."""
