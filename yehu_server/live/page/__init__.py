"""The panel: what the page in `web/` is given, written by the modules that the server plays by.

``python -m yehu_server.live.page web`` writes it.
"""
