"""The forward model: a chain of stages from the drive to the recorded samples.

* :mod:`sim.run` simulates a whole run and returns the dataset that a recorder would have written;
* :mod:`sim.rig` gathers the parameters of all stages and holds the nominal rigs;
* :mod:`sim.chain` runs stages in order, whole or in blocks, and keeps every signal between them;
* the stages themselves are one file each.
"""

from planar_motion_mechanism import refuse_intruders

refuse_intruders()
