"""Rows of the board that learn from campaigns: gradient boosting, isotonic and conformal shares."""
