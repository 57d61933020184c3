"""The laboratory's commands: a module for each."""

# What each command is for, for ``yehu-server --help``, which finds this as an entry point.
COMMANDS = {
    "body": "put the body of your own fiddle into the model, from measurements",
    "dataset": "make a labelled data set of sounds for machine learning",
    "practise": "find how each note of an instrument is best bowed",
    "sweep": "bow many strokes and name the regime of each, on all cores; draw the maps",
}
