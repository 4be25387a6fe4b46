"""The gauges: readings of the dynamometers from the forces in the struts."""
