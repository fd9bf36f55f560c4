"""Here specs of campaigns are loaded, changed and run by cleave sweep, or become jobs of a cluster."""
