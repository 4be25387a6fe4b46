"""``pmm devices ports``: the serial ports of this machine."""

from dataclasses import asdict

import click

from pmm.cli.devices import JSON, print_json, print_table
from pmm.cli.screen import output


@click.command()
@JSON
def ports(as_json: bool) -> None:
    """List this machine's serial ports, with the names that stay the same when plugged anew."""
    from hardware.serial_port import plugged_ports

    found = plugged_ports()
    if as_json:
        print_json("ports", {"ports": [asdict(one) for one in found]})
    elif found:
        print_table(
            ("device", "url", "description"),
            [(one.device, one.url, one.description) for one in found],
        )
    else:
        output().print("no serial ports")
