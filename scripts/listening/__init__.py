"""Compare sounds by ears that don't know which is which, and by what stands in for ears."""
