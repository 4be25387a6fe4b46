"""Drive, mechanism and model solved together, where the load acts back on the drive."""
