"""Here what the READMEs measure is written into them, from the files under results/."""
