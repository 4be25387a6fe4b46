"""Looking at a rig's devices one by one: who answers, what they read, which gauge is which.

What judges is pure (:mod:`pmm.devices.push_test`, :mod:`pmm.devices.pulses`); what runs a rig hands
its records on to it.
"""
