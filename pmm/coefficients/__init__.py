"""Coefficients of recorded campaigns: from folders of recordings to one table with its budget.

:mod:`~pmm.coefficients.settings` reads ``coefficients.toml``, :mod:`~pmm.coefficients.work` says
what is to be done with each recording, :mod:`~pmm.coefficients.reading` does it (in any process),
:mod:`~pmm.coefficients.solving` solves groups and draws trials, and
:mod:`~pmm.coefficients.workflow` puts it all together. :mod:`~pmm.coefficients.files` writes it.
``docs/coefficients-command.md`` has the keys.
"""

from typing import Final

DEFAULT_TRIALS: Final = 20_000  # of a Monte Carlo
