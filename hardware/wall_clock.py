"""What the wall's clock says, as it is written into files."""

from datetime import UTC, datetime


def utc_now() -> str:
    """Return date and time in ISO 8601, to the second."""
    return datetime.now(UTC).isoformat(timespec="seconds")
