"""Every method of knot insertion: one module a family, what they share, and the catalogue of them all."""
