"""One function a limit."""
