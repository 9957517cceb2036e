"""Case files: sections, consistency, resolved text, torque and lift of a case."""
