"""``pmm plan design``: the runs that make coefficients as well known as is asked.

``design_file`` reads ``design.toml``, ``targets`` what is asked in it, ``grid`` makes candidates of
its runs within the rig's limits, ``designing`` selects among them and says what they are expected
to tell, and ``plan_writer`` writes them as a plan.
"""
