"""Every method of knot insertion: one module per family, what they share, and the catalogue of them all."""
