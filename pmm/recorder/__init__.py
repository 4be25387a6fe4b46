"""What happens in a run is on the disk within a second: journals, completion marker, recovery."""
