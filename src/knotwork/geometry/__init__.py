"""What knot insertion tells of a curve or a surface: boxes, zeros, lengths; all certified by control points."""

from knotwork.geometry.roots import Zeros, zeros

__all__ = ["Zeros", "zeros"]
