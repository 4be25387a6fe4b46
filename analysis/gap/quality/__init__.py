"""Recordings that cannot be what they say, and the point about which a diagnosis is linear."""
