"""Studies: a grid of stops, run once each, kept in a journal, on threads or on a cluster."""
