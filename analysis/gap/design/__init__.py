"""Which run or measurement to make next."""
