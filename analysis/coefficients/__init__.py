"""From harmonics to added mass, damping and manoeuvring derivatives, with their uncertainty.

In the order of use: ``measured`` (a reading's strut phasors, with the covariance across channels),
``corrections`` (calibration, lag, zero runs), ``run`` (motion and loads about a point, dry runs),
``in_place`` (gain and lag from a run in air), ``solve`` (coefficients from one or several runs),
``uncertainty`` (linear budget and Monte Carlo), ``normalisation`` (prime, MMG, seakeeping).
``phasors`` carries the numbers.
"""
