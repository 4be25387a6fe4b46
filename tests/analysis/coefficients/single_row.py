"""The place of a coefficient that stands once in a campaign's table."""

from analysis.coefficients.campaign_result import CampaignCoefficients


def single_row(found: CampaignCoefficients, name: str, method: str | None = None) -> int:
    """Return its place; a name that stands more or less often is an error."""
    (row,) = found.rows(name, method=method)
    return row
