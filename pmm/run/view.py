"""What shows the runs that are made."""

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from pmm.run.run_control import RunControl


class View(Protocol):
    """Shows what is going on."""

    def show(self, control: "RunControl") -> None:
        """Look at the control, if it is time to."""
