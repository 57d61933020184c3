"""Many tasks at a time: on processes of this machine, or on a cluster."""
