"""What ``import yehu_server`` offers to Python programs; docs/python.md describes it.

The names are public in `yehu_server` itself. The modules here are where they live, and internal.
"""
