"""Host a simulated rig: ``python -m sim.devices simulated.toml --interface udp_multicast``."""

import argparse
import json
import sys
import time
from collections.abc import Sequence
from pathlib import Path

import can
from can.interfaces.udp_multicast import UdpMulticastBus

from hardware.description.errors import ConfigurationError
from sim.devices.bench_file import read_bench
from sim.devices.host import Host
from sim.devices.slcan import SlcanAdapter

_GROUP = UdpMulticastBus.DEFAULT_GROUP_IPv4


def main(arguments: Sequence[str]) -> int:
    """Host the rig of a file until ``quit`` comes on standard input; return 2 for a wrong file."""
    request = _parse(arguments)
    try:
        bench = read_bench(request.file)
        carrier, where = _carrier(request)
    except (ConfigurationError, can.CanError, OSError) as error:
        sys.stderr.write(f"{error}\n")
        return 2
    host = Host(
        bench,
        carrier,
        sys.stdin,
        sys.stdout,
        None if request.free_running else time.monotonic,
    )
    try:
        sys.stdout.write(json.dumps({"bus": where, "ports": host.ports}) + "\n")
        sys.stdout.flush()
        host.serve()
    except KeyboardInterrupt:
        pass
    finally:
        host.close()
        carrier.shutdown()
    return 0


def _carrier(
    request: argparse.Namespace,
) -> tuple[SlcanAdapter | UdpMulticastBus, dict[str, str | int]]:
    if request.interface == "slcan":
        adapter = SlcanAdapter()
        return adapter, {"interface": "slcan", "channel": adapter.path}
    options = {"port": request.port, "hop_limit": 0}
    bus = UdpMulticastBus(request.channel, **options)
    return bus, {"interface": "udp_multicast", "channel": request.channel, **options}


def _parse(arguments: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m sim.devices", description=__doc__)
    parser.add_argument("file", type=Path, help="what is simulated")
    parser.add_argument("--interface", choices=("udp_multicast", "slcan"), default="udp_multicast")
    parser.add_argument("--channel", default=_GROUP, help="multicast group")
    parser.add_argument("--port", type=int, default=43113, help="UDP port")
    parser.add_argument(
        "--free-running",
        action="store_true",
        help="SYNC alone is time: a controller may run as fast as it can",
    )
    return parser.parse_args(arguments)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
