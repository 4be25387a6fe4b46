"""Where along the chain a gap lies, and what the remainder looks like."""
