"""How fast a model outruns the echoes of its waves: ITTC 7.5-02-07-02.1, table 1."""

from typing import Final

import numpy as np

# Tank breadth over model length, and w U / g below which the walls matter.
_BREADTHS: Final = (0.5, 1.0, 2.0, 4.0)
_LIMITS: Final = (0.635, 0.378, 0.280, 0.245)


def echo_limit(breadth_over_length: float) -> float:
    """Return w U / g above which the walls' echoes miss the model.

    It is NaN outside the table, 0.5 to 4.

    Parameters
    ----------
    breadth_over_length
        Of the tank and the model; between the table's ratios the limit is interpolated.
    """
    return float(np.interp(breadth_over_length, _BREADTHS, _LIMITS, np.nan, np.nan))
