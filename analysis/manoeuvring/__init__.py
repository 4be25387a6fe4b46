"""What manoeuvring derivatives mean: the free ship's turns, zig-zags, spiral and stability.

``ship`` has the equations of motion, of the loads of ``hull`` (the derivatives) and ``steering``
(propeller and rudder); ``march`` carries many ships through a phase with a constant helm order at
once, ``manoeuvres`` puts phases together, ``stability`` looks at straight course, ``imo`` judges.
"""
