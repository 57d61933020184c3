"""The instrument compiled ahead of time: as WebAssembly for pages, as a library for C programs.

Both are made from the functions that the server plays by, and hold no Python.
"""
