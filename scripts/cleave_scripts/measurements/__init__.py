"""Here measurements become ratios, and what scripts/reference made becomes the stored set."""
