"""Recordings in, numbers out."""

from planar_motion_mechanism import refuse_intruders

refuse_intruders()
