"""Engine torque over the cycle."""
