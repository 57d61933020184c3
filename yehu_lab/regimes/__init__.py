"""How a bowed string moves: the rule that names its regime, and whole strokes judged by it.

Part of it is compiled, so the folder is registered.
"""

from pathlib import Path

from yehu_server.compile import cache_folder

cache_folder.register("yehu_lab", Path(__file__).parent)
