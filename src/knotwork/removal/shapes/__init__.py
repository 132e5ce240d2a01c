"""Reduction within a distance between shapes, not of parameters: certificate, lower bounds, polylines."""
