"""``pmm devices scan``: who answers on a bus and on serial ports."""

from typing import TYPE_CHECKING, Any

import click

from pmm.cli.devices import ANY, Target

if TYPE_CHECKING:
    from pmm.devices.survey import Survey


@click.command()
@ANY
@click.option("--listen", "listen_s", metavar="S", type=click.FloatRange(min=0.0), default=1.1,
              show_default=True, help="How long to listen for heartbeats and lines.")  # fmt: skip
def scan(listen_s: float, as_json: bool, **options: Any) -> None:
    """List who answers: identity, state, heartbeat, mapping.

    Nothing is changed: no SYNC, no state is commanded. With a rig's file, who is missing is named.
    """
    from pmm.cli.screen import busy, error_line, show
    from pmm.report.devices_document import scan_document

    with busy("scanning"):
        survey = _survey(Target(**options), listen_s)
    silent = [
        f"{name}: {port.device_kind}"
        for name, port in survey.heard_ports.items()
        if port.device_kind == "silent"
    ]
    faults = survey.faults + silent
    show(scan_document(survey, faults), as_json=as_json)
    for line in () if as_json else faults:
        error_line(line)
    if faults:
        raise click.exceptions.Exit(1)


def _survey(target: Target, listen_s: float) -> "Survey":
    from pmm.devices.survey import survey_bus, survey_port, survey_rig

    tables = target.tables()
    if tables is not None:
        return survey_rig(tables, listen_s)
    if target.interface:
        return survey_bus(target.bus(), listen_s)
    return survey_port(target.port_settings(), listen_s)
