"""Parameters of propeller and rudder from captive tests: the MMG standard method turned round.

``observations`` holds what was measured behind the model. ``load_factors`` tells what thrust and
normal force of the rudder do to the ship, ``inflow`` in which water propeller and rudder work,
``propulsion`` where thrust and resistance balance; ``identification`` does all three and keeps what
their uncertainties share. Forward, the equations are in ``analysis/manoeuvring/steering.py``.
"""
