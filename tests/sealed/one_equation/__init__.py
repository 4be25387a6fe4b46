"""One Gaussian for every hypothesis, as a row of the board: it is to take the diagnosis' place.

A hypothesis h says of the whitened difference r between measurement and simulation

    r = N b + s_h(theta) + tau K_h a + e,      b, a, e ~ N(0, 1)

with the tolerances' columns N, the effects' signature s_h, and a deviation of no particular form
whose size tau nobody knows by orders of magnitude. What is fitted is what the diagnosis fits; how
it is weighed has no rule beside this equation.
"""
