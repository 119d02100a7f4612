"""Section 3.3.1, eq. (6): a depth image of the map for each particle, by z-buffer ("raster", "vtk") or rays ("ray")."""
