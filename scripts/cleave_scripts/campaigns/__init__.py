"""Here a campaign becomes jobs of a cluster."""
