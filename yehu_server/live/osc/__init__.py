"""OSC: packets, sockets, limits on senders, calls, subscriptions, the status."""
