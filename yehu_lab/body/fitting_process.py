"""A fit in a process of its own, with one thread for linear algebra.

More would wait for each other, since matrices are small, and keep all cores busy meanwhile. How
many there are is read once, when NumPy loads, which is long over where a program calls.
"""

import os
import pickle
import subprocess
import sys
from typing import Any

from yehu_lab.body.body_file import Fit
from yehu_lab.body.fitting import fit
from yehu_lab.body.measurement import Measurement
from yehu_server.errors import YehuError
from yehu_server.util.files import error_reason
from yehu_server.util.processes import python_command

THREADS = "OPENBLAS_NUM_THREADS"


def fit_in_process(measurement: Measurement, **how: Any) -> Fit:
    """Fit a body as `fit` does; raises YehuError where that does, or the process ends."""
    if os.environ.get(THREADS) == "1":
        return fit(measurement, **how)
    try:
        done = subprocess.run(  # noqa: S603 - our own module
            python_command(__name__),
            input=pickle.dumps((measurement, how)),
            stdout=subprocess.PIPE,
            env=os.environ | {THREADS: "1"},
            start_new_session=True,  # Ctrl-C is for the parent, which kills it
            check=False,
        )
    except OSError as error:
        raise YehuError(
            f"the process that fits a body cannot be started: {error_reason(error)}"
        ) from error
    if done.returncode != 0:
        raise YehuError(f"the process that fits a body ended with code {done.returncode}")
    found = pickle.loads(done.stdout)  # noqa: S301 - written below
    if isinstance(found, YehuError):
        raise found
    return found  # type: ignore[no-any-return]


def main() -> None:
    """Fit what comes as input; write what is found, or the error."""
    measurement, how = pickle.load(sys.stdin.buffer)  # noqa: S301 - written above
    found: Fit | YehuError
    try:
        found = fit(measurement, **how)
    except YehuError as error:
        found = error
    sys.stdout.buffer.write(pickle.dumps(found))


if __name__ == "__main__":
    main()
