"""What the tests of a campaign say of rig and model: zeros, check weights, plucks, slow tests."""
