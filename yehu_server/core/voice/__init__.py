"""Following a voice as it sings: what is heard of it, and the wishes that it comes to. Compiled."""
