"""Mutations of the product, drawn at random, and whether the tests that cover them notice."""
