"""A plan: what is to be run, on which rig, in what order, and whether the rig can do it.

``plan.toml`` is read by :func:`pmm.plan.plan.read_plan` and ``rig.toml`` by
:func:`pmm.plan.rig_file.read_rig_file`; :func:`pmm.plan.checks.check_plan` says what the rig cannot
do and what the field advises against; :func:`pmm.plan.campaign_writer.write_campaign` turns the
finished runs into a campaign folder for the analysis. Nothing here knows the simulator.
"""
