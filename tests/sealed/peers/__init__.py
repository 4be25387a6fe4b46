"""Other ways to answer a board: trivial ones as controls, and what other programs can do."""
