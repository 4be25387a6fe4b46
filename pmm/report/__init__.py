"""What a person sees of an analysis: figures (:mod:`pmm.report.plots`) and a page to pass on.

Figures are drawn without any global state of the plotting library, and the same analysis gives the
same bytes.
"""
