"""From a campaign's tows with propeller and rudder to the parameters of both.

``settings`` reads ``steering.toml``, ``reading`` makes means of the recordings, ``workflow`` does
all of it; the equations are in ``analysis/steering``.
"""
