"""What `scripts/report` draws: every figure, the verdicts and the page, from files alone."""
