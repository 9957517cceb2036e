"""Gentler torques for the lift."""
