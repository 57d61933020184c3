"""The laboratory: how the model bows and sounds, for those who study fiddles and build them.

Sweeps and regimes of motion, data sets, fitted bodies, their pictures, and the search for how each
note is best bowed. Its commands are among those of `yehu-server`, its names among `yehu_server`'s.
"""
