"""One Gaussian for every hypothesis of a diagnosis, of campaigns and of pendulums alike.

A hypothesis h says of the whitened difference r between measurement and simulation

    r = N b + s_h(theta) + F_h f + tau K_h a + e,      b, f, a, e ~ N(0, 1)

with the columns N of what every good rig and model is off by within its tolerances, the signature
s_h of its effects, the columns F_h of the other forms of their families, and a deviation of no
particular form whose size tau nobody knows by orders of magnitude. What a hypothesis does not name
is integrated out; nothing is corrected afterwards. ``docs/gap-theory.md`` has the equations.
"""
