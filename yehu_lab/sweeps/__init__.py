"""Many strokes: studies, how they are run and kept, and how their results are drawn."""
