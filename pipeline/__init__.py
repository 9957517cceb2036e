"""The road from a case file to a verdict."""
