"""Cam-roller contact: closed form and finite elements."""
