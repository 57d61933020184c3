"""Memory that the audio process shares is mapped before a callback uses it."""

import mmap
import sys

import pytest

from yehu_server.system.memory import SharedMemory, map_all

PAGES = 2000


@pytest.mark.skipif(sys.platform != "linux", reason="counts page faults as Linux does")
def test_memory_that_is_mapped_takes_no_page_fault_at_its_first_use() -> None:
    import resource

    memory = SharedMemory(PAGES * mmap.PAGESIZE)
    map_all(memory.buffer)
    before = resource.getrusage(resource.RUSAGE_THREAD).ru_minflt
    for at in range(0, len(memory.buffer), mmap.PAGESIZE):
        memory.buffer[at] = 1
    assert resource.getrusage(resource.RUSAGE_THREAD).ru_minflt - before < PAGES // 10
    memory.close()
