"""Follower, guides, roller and spring: the loads on the cam."""
