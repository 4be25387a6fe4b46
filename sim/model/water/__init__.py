"""The water around the model: added mass and damping, their memory, and forces that are not linear.

* :mod:`sim.model.water.radiation` is what the hull needs to know of the water: a state space;
* :mod:`sim.model.water.tables` reads added mass and damping over frequency;
* :mod:`sim.model.water.memory` fits the state space to such a table, by
  :mod:`sim.model.water.vector_fitting` and :mod:`sim.model.water.passive_fit`;
* :mod:`sim.model.water.fitted_memory` is the result, with what the fit leaves of the table;
* :mod:`sim.model.water.tank` adds the tank's walls to it.
"""
