"""A bound on the memory of this process."""

import sys


def limit_memory(most_bytes: int) -> None:
    """Take no more memory than that, where the system can; Windows and macOS cannot.

    Parameters
    ----------
    most_bytes
        0 for no limit.
    """
    if sys.platform == "win32" or not most_bytes:
        return
    import resource

    hard = resource.getrlimit(resource.RLIMIT_AS)[1]
    try:
        resource.setrlimit(resource.RLIMIT_AS, (most_bytes, hard))
    except (OSError, ValueError):
        return  # a system that knows no such limit, or has a lower one
