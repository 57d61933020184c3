"""How a bowed string moves: the rule that names its regime, and whole strokes judged by it."""
