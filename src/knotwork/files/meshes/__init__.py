"""Files of triangles, one module a format: what `flatten` makes of surfaces."""
