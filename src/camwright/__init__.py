"""Camwright: from a machine's torque to a balancing cam with a sign-off verdict."""
