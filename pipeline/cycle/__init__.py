"""Loads, contact and part loads over one cam turn."""
