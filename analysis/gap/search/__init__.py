"""What could explain a gap: first looks, fits, and the weighing of all of them."""
