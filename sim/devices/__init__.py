"""The rig's devices, simulated on the protocols that the real ones speak.

In a process of its own: :mod:`sim.devices.host`; in the controller's: :mod:`sim.devices.bus` and
``sim://`` (:mod:`sim.devices.registry`). What moves and measures is :mod:`sim.devices.world`.
"""
