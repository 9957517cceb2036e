"""Studies beside a run: inspection, two cylinders, smoothers, redesign, papers."""
