"""What ``pmm report`` does: analyse, then write the page."""

import shlex
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pmm.campaign.file_names import CAMPAIGN_FILE
from pmm.cli.coefficients_running import analysed, finish
from pmm.cli.folders import check_file
from pmm.cli.hints import program
from pmm.cli.screen import busy, output
from pmm.document.page import write_page
from pmm.report.coefficients_document import report_document

REPORT_FILE = "report.html"


def run(options: Mapping[str, Any]) -> None:
    """Write a campaign's report.

    Raises
    ------
    ConfigurationError, DataError
        As ``pmm coefficients``; or the page is there already.
    """
    path = _path(options)
    check_file(path, "--output", overwrite=options["overwrite"])
    outcome, files = analysed(options, hashed=True)
    title = options["title"] or f"Coefficients of {', '.join(outcome.names)}"
    with busy("drawing the page"):
        command = shlex.join([Path(program()).name, *sys.argv[1:]])
        write_page(report_document(outcome), path, title=title, command=command, read=files)
    output().print(str(path), soft_wrap=True)
    finish(outcome)


def _path(options: Mapping[str, Any]) -> Path:
    if options["output"] is not None:
        return Path(options["output"])
    first = Path(options["campaigns"][0])
    return (first.parent if first.name == CAMPAIGN_FILE else first) / REPORT_FILE
