"""What judges a gap diagnosis: answers against the keys of a board of sealed cases.

It reads folders only (``docs/sealed.md``); ``docs/sealed-scoring.md`` says what each column means
and works an example out by hand.
"""
