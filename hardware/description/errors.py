"""The base of every error this project raises on purpose."""

from typing import ClassVar


class PmmError(Exception):
    """Something the user can act on: the message names what, the value, the limit and the remedy.

    ``exit_status`` is what the command line returns: 1 where the data or the rig says no, 2 where
    the request itself was wrong.
    """

    exit_status: ClassVar[int] = 1


class DataError(PmmError):
    """A recording does not carry what was asked of it (missing channel, gap, no periods ...)."""


class ConfigurationError(PmmError):
    """A configuration file or an option is wrong: unknown key, value out of range, bad unit."""

    exit_status: ClassVar[int] = 2
