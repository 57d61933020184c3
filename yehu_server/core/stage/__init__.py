"""The stage: where players sit, the room, and the mix of all to two channels. Compiled."""
