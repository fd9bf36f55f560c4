"""Here the report is drawn, from files alone: every figure, the verdicts and the page."""
