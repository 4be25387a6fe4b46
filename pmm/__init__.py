"""Planar motion mechanism: run tests and analyse their recordings."""

from planar_motion_mechanism import refuse_intruders

refuse_intruders()
