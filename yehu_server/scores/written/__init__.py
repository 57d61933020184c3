"""What a written score says, how its marks are played, and how it is laid out."""
