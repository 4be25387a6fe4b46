"""What moves and what measures, and the words for both (:mod:`hardware.description`)."""
