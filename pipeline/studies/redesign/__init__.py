"""Redesign: parts of the catalogues tried in a case, the cam drawn anew for each of them."""
