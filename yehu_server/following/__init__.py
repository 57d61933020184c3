"""The analysis of recordings of one voice, and the performances made of them."""
