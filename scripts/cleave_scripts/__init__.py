"""The modules of the commands in scripts/. A room imports from rooms above it in the list of README.md, never from below."""
