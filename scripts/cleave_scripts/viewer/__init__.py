"""Here recorded motion becomes a page that replays it; its own sources are in web/."""
