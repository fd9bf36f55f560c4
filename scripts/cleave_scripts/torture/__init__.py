"""Here the program is tried by whatever may happen to it and to its files, and judged by what its READMEs promise."""
