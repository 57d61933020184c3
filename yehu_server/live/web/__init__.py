"""OSCQuery and metrics, by HTTP and WebSocket."""
