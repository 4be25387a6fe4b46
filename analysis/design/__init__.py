"""Which runs to make so that coefficients become as well known as is asked, before any is made.

In the order of use: ``belief`` (a run as it would be read if the hull were as believed), ``noise``
(what the resolver would leave open), ``regression`` (what each run would tell), ``selection`` (the
runs that are worth their time), ``expectation`` (what the product's own fit would say of them).
Nothing here knows a file or a rig's device.
"""
