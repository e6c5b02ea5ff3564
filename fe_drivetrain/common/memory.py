"""Memory of this process, on systems that say."""

import sys
from pathlib import Path

STATUS = Path("/proc/self/status")


def peak_memory() -> int | None:
    """Largest resident memory of this process so far [bytes].

    Returns
    -------
    int or None
        None where the system does not say, as Windows.
    """
    # Linux hands ru_maxrss on from the process that started this one; VmHWM is this one's own
    lines = STATUS.read_text(encoding="ascii").splitlines() if STATUS.exists() else []
    found = [line.split() for line in lines if line.startswith("VmHWM:")]
    if found:
        return 1024 * int(found[0][1])
    try:
        import resource
    except ImportError:
        return None
    # Linux counts in KiB, macOS in bytes
    unit = 1 if sys.platform == "darwin" else 1024
    return unit * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
