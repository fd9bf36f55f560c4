"""Here results enter: programs are run, and what they write, and what the paper printed, is read and named."""
