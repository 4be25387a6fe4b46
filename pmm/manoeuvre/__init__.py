"""A ship's manoeuvres from its file: tables, draws of derivatives, quantities with intervals."""
