"""What the console takes from the network and no more; ``docs/console.md`` has the same table.

None of them is met by people at a rig. They keep whoever floods the console, by mistake or not,
from the loop and from the quick stop.
"""

from typing import Final

MOST_STREAMS: Final = (
    256  # pages at a time: some 20 kB and a send in each picture; ten times a tank
)
MOST_HALF_SENT: Final = 64  # connections whose request is not complete; the oldest one is ended
YOUNG_S: Final = 1.0  # for which a request that is half sent is not ended, however many there are
MOST_CONNECTIONS: Final = 512  # beside the pages; half of the files that a process usually may open
REQUEST_S: Final = 10.0  # from a request's first byte to its last: 1 MiB at 1 Mbit/s
WRONG_TOKENS: Final = 5  # of an address, from which on it has to wait: 1 s, then twice as long each
LONGEST_LOCKOUT_S: Final = 900.0  # of an address: a hundred tries a day
MOST_ADDRESSES: Final = 1024  # that wrong tokens are counted for; the oldest is forgotten
SLOW_S: Final = 10.0  # that a page's stream may be full without anything of it being taken
SILENT_S: Final = 60.0  # without page or request of whoever has control; a page is back in seconds
MOST_CHECKS: Final = 4  # plans that are checked or wait for it; as many again for who has control
MOST_PROPOSALS: Final = 32  # that wait; 1 MiB each at most
CHECK_S: Final = 120.0  # of the processor, for reading a plan: 10000 runs take 10 to 20 s
CHECK_MEMORY: Final = 1 << 30  # bytes, for reading plans: 10000 runs take 180 MB
MOST_WAITING: Final = 32  # plans in the queue; each of 10000 runs, they take 110 MB in the loop
LARGEST_HEADERS: Final = 16 << 10  # bytes: browsers send less than 2 kB
LARGEST_REQUEST: Final = 16 << 10  # bytes: an answer and its question are 9 kB at most
LARGEST_PLAN: Final = 1 << 20  # bytes: 10000 runs, each with a table of its own
LARGEST_MESSAGE: Final = 1 << 10  # bytes, from a browser: none is expected, and none is taken
