"""The drive: how shaft and carriage move, told or under load."""
