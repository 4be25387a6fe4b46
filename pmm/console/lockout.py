"""Wrong tokens: counted for each address, and the more there are the longer it has to wait.

Only logging in waits. A page that has logged in keeps its cookie whatever comes from its address,
so that nobody is kept from the quick stop.
"""

from collections.abc import Callable
from dataclasses import dataclass
from ipaddress import IPv6Address, ip_address
from typing import Final

from pmm.console.limits import LONGEST_LOCKOUT_S, MOST_ADDRESSES, WRONG_TOKENS

_FIRST_S: Final = 1.0  # doubled with each wrong token beyond those that are free
_IPV6_HOSTS: Final = 64  # bits that whoever has an IPv6 network may choose by himself


@dataclass
class _Count:
    wrong: int = 0
    until_s: float = 0.0
    turned_away: int = 0


class Lockout:
    """Counts wrong tokens by address.

    Parameters
    ----------
    clock
        Monotonic seconds.
    """

    def __init__(self, clock: Callable[[], float]) -> None:
        self._clock = clock
        self._counts: dict[str, _Count] = {}

    def wait_s(self, address: str) -> float:
        """Return how long an address has to wait; 0 if it may try. Trying too early is counted."""
        count = self._counts.get(_network(address))
        if count is None:
            return 0.0
        left_s = max(count.until_s - self._clock(), 0.0)
        count.turned_away += left_s > 0.0
        return left_s

    def count_wrong(self, address: str) -> tuple[str, bool]:
        """Count a wrong token; return what to log, and whether it first shuts the address out."""
        key = _network(address)
        count = self._counts.pop(key, None) or _Count()
        self._counts[key] = count  # the latest is last
        if len(self._counts) > MOST_ADDRESSES:
            del self._counts[next(iter(self._counts))]
        count.wrong += 1
        beyond = count.wrong - WRONG_TOKENS
        lasts_s = min(_FIRST_S * 2.0 ** min(beyond, 30), LONGEST_LOCKOUT_S) if beyond >= 0 else 0.0
        count.until_s = self._clock() + lasts_s
        between, count.turned_away = count.turned_away, 0
        said = f"wrong token, number {count.wrong} from {key}"
        said += f", {between} more turned away since the last" if between else ""
        said += f"; it waits {lasts_s:g} s" if lasts_s else ""
        return said, beyond == 0

    def forget_wrong(self, address: str) -> None:
        """Forget the wrong ones: somebody has found the right one."""
        self._counts.pop(_network(address), None)


def _network(address: str) -> str:
    """Return what one person may hold: an IPv4 address, or a network of IPv6."""
    try:
        host = ip_address(address.partition("%")[0])
    except ValueError:
        return address
    if not isinstance(host, IPv6Address):
        return str(host)
    if host.ipv4_mapped is not None:
        return str(host.ipv4_mapped)
    return f"{IPv6Address(int(host) >> _IPV6_HOSTS << _IPV6_HOSTS)}/{_IPV6_HOSTS}"
