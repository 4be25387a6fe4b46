"""The model on its mounting, in water: what forces act, and how it gives way to them."""
