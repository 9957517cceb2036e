"""Page, figures and fields from a finished run; never solves."""
