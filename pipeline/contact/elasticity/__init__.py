"""Plane-strain elasticity: closed forms and finite elements."""
