"""Settings for all tests."""

import os

from hypothesis import settings

# Set before numpy loads: the dense references work on small matrices, where the threads of
# two test processes only get in each other's way.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# The same cases on every machine, and no deadline: a first call may have to compile.
settings.register_profile("yehu", deadline=None, derandomize=True, database=None)
settings.load_profile("yehu")
