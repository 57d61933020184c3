"""The running instrument: events, controls, the model, the output, in one compiled callback."""
