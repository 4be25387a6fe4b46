"""Uncertainty: values with covariance and degrees of freedom, budgets, and Monte Carlo."""
