"""What people look at: the figures of a run."""
