"""The running instrument: wishes, player, controls, model, output, in one compiled callback."""
