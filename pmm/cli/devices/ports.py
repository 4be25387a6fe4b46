"""``pmm devices ports``: the serial ports of this machine."""

import click

from pmm.cli.options import JSON


@click.command()
@JSON
def ports(as_json: bool) -> None:
    """List this machine's serial ports, with the names that stay the same when plugged anew."""
    from hardware.serial_port import plugged_ports
    from pmm.cli.screen import show
    from pmm.report.devices_document import ports_document

    show(ports_document(plugged_ports()), as_json=as_json)
