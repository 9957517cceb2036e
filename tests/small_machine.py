"""Case of a small machine, short of many data, that tests complete or change as text."""

from pathlib import Path

TEXT = (Path(__file__).parent / "data" / "small_machine.toml").read_text(encoding="utf-8")


def small_machine(name):
    """Text of the case file under a name."""
    return TEXT.replace("@NAME@", name)
