"""Whole mechanisms of the papers: valve cams, slider-crank and eccentric cam."""
