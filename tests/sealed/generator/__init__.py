"""A second reality, made in the time domain, that shares nothing with ``sim`` or ``analysis``."""
