"""The gauges: what the dynamometers make of the forces in the struts."""
