"""What a written score says, and how its marks are played."""
