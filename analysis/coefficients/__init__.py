"""From harmonics to added mass, damping and manoeuvring derivatives, with their uncertainty.

In the order of use: ``strut_phasors`` (mean and harmonics of the struts' channels, with their joint
covariance), ``strut_cycle`` and ``corrections`` (calibration, lag, zero runs), ``body_axes`` and
``body_cycle`` (motion and loads of the model), ``hull_cycle`` (inertia and weight taken off),
``linear_fit`` and ``cycle_fit`` (coefficients), ``campaign`` (all runs of a campaign),
``normalisation`` (prime, MMG, seakeeping). ``phasors`` holds the numbers and their uncertainty.
"""
