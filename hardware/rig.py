"""A rig in operation: its devices, its loop, its latched faults.

The control code sees :meth:`Rig.cycle` only. In simulated time it is pumped as fast as it returns;
in real time a pacer keeps it to the clock. Nothing else differs.
"""

from collections.abc import Callable, Sequence
from contextlib import ExitStack

from hardware.description.errors import PmmError
from hardware.driver import Prompt, Services
from hardware.errors import (
    HardwareError,
    NotReadyError,
    Reaction,
    TransitionTimeoutError,
    as_fault,
    worst,
)
from hardware.line_log import LineObserver, heard_ports
from hardware.master import Clock, Master, Observer
from hardware.pacing import Pacer
from hardware.reconnection import reconnect
from hardware.rest import come_to_rest
from hardware.rig_configuration import RigConfiguration, check
from hardware.rig_devices import RigDevices
from hardware.roles import Cycle, Device, PositionAxis, Powered
from hardware.serial_port import Ports, SerialPort
from hardware.watch import WatchLimits


class Rig:
    """Opens a rig; use it in a ``with`` block.

    Parameters
    ----------
    clock
        Monotonic seconds; only limits waiting.
    pacer
        When cycles begin.
    prompt
        How the operator is asked (see :class:`hardware.driver.Services`).
    observers
        Called with every CAN frame sent and received.
    line_observers
        Called with the cycle's number, the device's name and the line for every serial line.
    ports
        Opens serial ports; a replay opens the logged ones.

    Attributes
    ----------
    shaft, eccentricity, phase, photocell, inclinometer, forces, carriage, angles
        The devices by role, behind the interlock; absent ones are ``None``.
    path
        The shaft as what is told its struts' path; ``None`` where they follow no other.
    follower
        The carriage as what is told its speed in every cycle; ``None`` where it cannot be.
    faults
        What is latched: nothing moves before :meth:`reset`.
    prompt
        How the operator is asked; on a simulated rig by way of its simulated operator.

    Raises
    ------
    ConfigurationError
        If the configuration does not fit together.
    BusOpenError, PortOpenError
        If a bus or port cannot be opened; what was open is closed again.
    """

    def __init__(
        self,
        configuration: RigConfiguration,
        clock: Clock,
        pacer: Pacer,
        prompt: Prompt,
        observers: Sequence[Observer] = (),
        line_observers: Sequence[LineObserver] = (),
        ports: Ports = SerialPort,
    ) -> None:
        check(configuration)
        self.configuration = configuration
        self.faults: list[HardwareError] = []
        self.number = 0
        self._prepared = False
        self._pacer = pacer
        self._devices = RigDevices(lambda: self.faults)
        self._period_s = 1.0 / configuration.sample_rate_hz
        self.master: Master | None = None
        try:
            if configuration.bus is not None:
                self.master = Master(configuration.bus, clock, observers)
            operator = self.master.operator if self.master is not None else None
            self.prompt = prompt = operator(prompt) if operator is not None else prompt
            port = heard_ports(ports, line_observers, lambda: self.number)
            rate_hz = configuration.sample_rate_hz
            services = Services(clock, prompt, rate_hz, self.master, port=port)
            self._devices.open(configuration, services)
        except BaseException:
            self.close()
            raise
        opened = self._devices
        self.shaft, self.eccentricity, self.phase = opened.shaft, opened.eccentricity, opened.phase
        self.path, self.follower = opened.path, opened.follower
        self.photocell, self.inclinometer = opened.photocell, opened.inclinometer
        self.carriage, self.angles = opened.carriage, opened.angles
        self._watch, self.forces = opened.watch, opened.watch.forces

    def __enter__(self) -> "Rig":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def prepare(self) -> None:
        """Configure all devices and start the bus; the drives stay without power.

        Raises
        ------
        ConfigurationError, SdoTimeoutError, SdoAbortError
            If a device does not answer, refuses, or cannot do what its role needs.
        ProgramError
            If its driver fails over what it answers.
        """
        if self.master is not None:
            self.master.prepare()
        for device in self._devices.opened:
            try:
                device.prepare()
            except PmmError:
                raise
            except Exception as error:  # a driver that meets an answer that nobody foresaw
                raise as_fault(device.name, error) from error
        if self.master is not None:
            self.master.start()
        self._prepared = True

    def cycle(self) -> Cycle:
        """Run one cycle: bus, devices, outputs.

        Raises
        ------
        HardwareError
            The most severe of what was found in this cycle, after the cycle is complete and what it
            asks for (quick stop, profile stop, silence) is on its way; the others are its notes.
            Each fault is raised once and latched; a lost bus is raised in every cycle. What a
            driver raises beside is a fault too: a cycle is always completed.
        """
        late = self._pacer.wait()
        self.number += 1
        cycle = Cycle(self.number, self.number * self._period_s, late)
        errors = self.master.exchange(self.number) if self.master else []
        for device in self._devices.opened:
            try:
                device.tick(cycle)
            except Exception as error:  # a driver of a lab's own may raise anything
                errors.append(as_fault(device.name, error))
        errors += self._watch.look()
        fresh = [error for error in errors if self._latch(error)]
        fresh += self._react(fresh)
        if self.master is not None:
            lost = [error for error in self.master.flush() if self._latch(error)]
            fresh += lost + self._react(lost)
        if fresh:
            raise worst(fresh)
        return cycle

    def run_until(self, condition: Callable[[], bool], within_cycles: int, event: str) -> int:
        """Cycle until a condition holds; return how many cycles it took.

        Raises
        ------
        TransitionTimeoutError
            If it does not hold in time; ``event`` says what was waited for.
        HardwareError
            As :meth:`cycle` does.
        """
        for count in range(within_cycles + 1):
            if condition():
                return count
            self.cycle()
        raise TransitionTimeoutError("rig", f"{event}: not within {within_cycles} cycles")

    def limit(self, limits: WatchLimits) -> None:
        """Watch speed and loads against these limits, in every cycle from now on."""
        self._watch.limit(limits)

    def stop(self) -> None:
        """Profile stop of all axes; an axis that refuses does not keep the others from it."""
        self._command_each(lambda axis: axis.stop())

    def quick_stop(self) -> None:
        """Quick stop of all axes; an axis that refuses does not keep the others from it."""
        self._command_each(lambda axis: axis.quick_stop())

    def reset(self) -> None:
        """Forget the latched faults and reset those of the devices: on the operator's demand.

        What is not heard is connected again first, with the loop going on meanwhile.

        Raises
        ------
        NotReadyError
            If an axis is not seen to rest; nothing was reset.
        HardwareError
            If a device cannot be reset (a port is still unplugged); its fault stays latched.
        """
        reconnect(self._devices.opened, self.cycle, self._period_s)
        moving = [axis.name for axis in self.powered() if axis.moving]
        if moving:
            raise NotReadyError(
                "rig",
                f"cannot reset while {' and '.join(moving)} moves or is not heard; wait until it "
                "stands (the emergency stop holds it), or start anew if it is not heard",
            )
        for device in self._devices.opened:
            device.reset_fault()
        if self.master is not None:
            self.master.reset()
        self.faults.clear()

    @property
    def notes(self) -> tuple[str, ...]:
        """What devices lack and are used without, a sentence each; known once prepared."""
        opened = self._devices.opened
        return tuple(note for device in opened for note in getattr(device, "notes", ()))

    @property
    def devices(self) -> tuple[Device, ...]:
        """All devices, in the order in which they tick."""
        return tuple(self._devices.opened)

    def latch(self, error: HardwareError) -> None:
        """Latch a fault that was found above the devices, and do what it asks for.

        Nothing is raised: an axis that refuses is latched beside it.
        """
        self._latch(error)
        self._react([error])

    def powered(self) -> tuple[Powered, ...]:
        """Return what moves, as far as the rig has it."""
        drives = tuple(drive for drive in (self.shaft, self.carriage) if drive is not None)
        return (*drives, *self.axes())

    def axes(self) -> tuple[PositionAxis, ...]:
        """Return the axes that are set before a run and stay in it."""
        axes = (self.eccentricity, self.phase, *self.angles.values())
        return tuple(axis for axis in axes if axis is not None)

    def _command_each(self, command: Callable[[Powered], None]) -> None:
        failed = []
        for axis in self.powered():
            try:
                command(axis)
            except Exception as error:  # whatever it is, the next axis has to stop
                failed.append(as_fault(axis.name, error))
        if failed:
            raise worst(failed)

    def close(self) -> None:
        """Leave the axes at rest and without power, close devices and bus; may be called twice."""
        try:
            if self._prepared:
                self._prepared = False
                come_to_rest(self)
        finally:
            self._let_go()

    def _let_go(self) -> None:
        devices, self._devices.opened = self._devices.opened, []
        with ExitStack() as stack:  # one that does not let go does not keep the others from it
            if self.master is not None:
                stack.callback(setattr, self, "master", None)
                stack.callback(self.master.close)
            for device in reversed(devices):
                stack.callback(device.close)

    def _latch(self, error: HardwareError) -> bool:
        """Keep a fault that stops the rig; tell whether it is to be raised."""
        if error.reaction < Reaction.PROFILE_STOP:
            return True
        keys = {(type(fault), fault.device) for fault in self.faults}
        new = (type(error), error.device) not in keys
        if new:
            self.faults.append(error)
        return new or error.reaction is Reaction.END_RUN

    def _react(self, errors: Sequence[HardwareError]) -> list[HardwareError]:
        """Do what faults ask for; return what went wrong in that, which is latched too."""
        reaction = max((error.reaction for error in errors), default=Reaction.REFUSE)
        if reaction is Reaction.END_RUN and self.master is not None:
            self.master.healthy = False
        if reaction < Reaction.PROFILE_STOP:
            return []
        try:
            (self.quick_stop if reaction >= Reaction.QUICK_STOP else self.stop)()
        except HardwareError as error:
            return [error] if self._latch(error) else []
        return []
