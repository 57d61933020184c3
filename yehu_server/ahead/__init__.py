"""The instrument compiled ahead of time, without Python: WebAssembly for pages, a C library."""
