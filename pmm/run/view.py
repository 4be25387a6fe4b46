"""What shows the runs that are made."""

from typing import Protocol, TypeVar

Control_contra = TypeVar("Control_contra", contravariant=True)


class View(Protocol[Control_contra]):
    """Shows what is going on."""

    def show(self, control: Control_contra) -> None:
        """Look at the control, if it is time to."""
