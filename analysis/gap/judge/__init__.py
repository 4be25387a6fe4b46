"""What the weighed hypotheses mean, and how far the gap shrinks on withheld runs."""
