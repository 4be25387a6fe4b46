"""One content, three renderers: what a command found, for a terminal, a page and programs."""
