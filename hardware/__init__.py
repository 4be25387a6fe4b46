"""What moves and what measures, and the words for both (:mod:`hardware.description`)."""

from planar_motion_mechanism import refuse_intruders

refuse_intruders()
