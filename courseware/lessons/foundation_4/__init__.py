"""Foundation F4, two views on spheres: the essential matrix, distance and its error, directions and ranges together."""
