"""The forward model: a chain of stages from the drive to the recorded samples."""
