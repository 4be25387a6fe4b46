"""The gap diagnosis of campaigns: files in, answers out (:mod:`analysis.gap` does the thinking)."""
