"""The way to rest: of a run that ends, and of a fault."""

from typing import Final

from hardware.errors import HardwareError, NotAtRestError
from hardware.limits import COASTING_S, REST_DEADLINE_S
from pmm.run.conduct import Conduct
from pmm.run.states import FAULTS
from pmm.run.status import Alarms

_REST_S: Final = 3.0  # for drives that are not heard any more, or that quick-stop


class Stopper:
    """Brings the axes to rest and takes their power off.

    Attributes
    ----------
    winding_down
        Whether the axes of a fault are on their way to rest.
    """

    def __init__(self, conduct: Conduct, alarms: Alarms) -> None:
        self._conduct, self._alarms = conduct, alarms
        self.winding_down = False
        self._heard = True
        self._power_taken = False

    def power_off(self) -> None:
        """Take the power off each axis as soon as it rests."""
        for axis in self._conduct.rig.powered():
            axis.disable()

    def call_off(self) -> None:
        """Ask people for nothing more, and tell those who drive the carriage to stop it."""
        c = self._conduct
        c.questions.withdraw()
        if c.surroundings.forget_carriage():
            self._alarms.add("carriage: stop it now; people drive it and nothing else does")

    def at_rest(self) -> bool:
        """Return whether nothing moves and all is answered; at rest the shaft loses its power.

        Raises
        ------
        NotAtRestError
            If an axis still moves after its time, and nobody is asked for anything.
        """
        c = self._conduct
        if c.command_given and c.towed:  # on its way back the carriage has a deadline of its own
            c.rested_since = c.rig.number
            return c.questions.ask_on() and not c.moving
        if c.moving:
            late = c.elapsed_s > _REST_S + c.ramp_s
            if late and not c.questions.present:
                raise _still_moving(heard=True)
            return False
        if not c.command_given:
            c.command_given = True
            c.rested_since = c.rig.number if c.rested_since is None else c.rested_since
            if c.rig.shaft is not None:
                c.rig.shaft.disable()
            self._send_back()
        return c.questions.ask_on() and not c.moving

    def _send_back(self) -> None:
        """Send the carriage back where the run has towed, or have it brought back."""
        c = self._conduct
        if c.rig.carriage is None or not c.towed:
            return
        if not c.rig.carriage.returns:
            c.questions.ask(c.surroundings.fetch())
        elif not c.leaves_plan:
            c.rig.carriage.go_back()

    def begin(self, cause: HardwareError) -> None:
        """Begin to wind down in a fault; the rig has told the axes to stop already."""
        self.winding_down, self._power_taken = True, False
        self._heard = FAULTS[cause.reaction].axes_heard

    def wound_down(self) -> bool:
        """Go on in a fault; tell whether this is the cycle in which it ends, with the power off.

        What asks for a quick stop asks for the power to go, too: a drive takes both as one command,
        and its deadline begins.
        """
        c = self._conduct
        if not self._power_taken and any(FAULTS[r.reaction].takes_power for r in c.rig.faults):
            self._power_taken = True
            self.power_off()
        patience_s = c.ramp_s + REST_DEADLINE_S + COASTING_S if self._heard else _REST_S
        if c.moving and c.elapsed_s < patience_s:
            return False
        if c.moving:
            self._alarms.add(str(_still_moving(heard=self._heard)))
        self.power_off()
        self.winding_down = False
        c.rested_since = c.rig.number
        return True

    def give_up(self) -> None:
        """Wind down no further: the way to rest cannot be followed any more."""
        self.winding_down = False


def _still_moving(*, heard: bool) -> NotAtRestError:
    why = (
        "an axis still moves after its time for a stop"
        if heard
        else "the bus is lost and the drives stop by themselves, but nobody hears it"
    )
    return NotAtRestError("rig", f"{why}; look at it, and use the emergency stop if it turns")
