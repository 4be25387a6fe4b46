"""The mechanism: from the shaft to struts and model, in exact geometry."""
