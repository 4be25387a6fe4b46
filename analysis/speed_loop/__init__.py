"""The speed loop of a shaft: what it is, how it is found, and how it had better be set."""
