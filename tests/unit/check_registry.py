"""How every check is tried: importing the registries fills `TRIED`."""

import registry_design
import registry_groove
import registry_parts
import registry_verification
from check_tools import BY_ID, TRIED, check

__all__ = ["BY_ID", "BY_ITSELF", "DATA", "MADE_LATER", "TRIED", "check"]

DATA = {name for name in BY_ID if name.startswith("data_")}
"""Of the data of each part: tried in test_part_data."""
BY_ITSELF = {"mesh_reaction"}
"""Solved here and now: tried below with the guides' answer put in its place."""
MADE_LATER = {"tolerance_corners", "waivers_without_effect"}
"""Made from other checks: tried in test_corners, test_checks_by_hand and test_checks_demands."""
REGISTRIES = (registry_design, registry_groove, registry_parts, registry_verification)
