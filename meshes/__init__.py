"""Finite-element meshes of the bodies and of the contact patch."""
