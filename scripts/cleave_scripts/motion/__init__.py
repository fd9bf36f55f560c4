"""Here recorded motion becomes pictures: bodies in their shapes, parts in colours, rendered by POV-Ray."""
