"""Section 3.3.1, eq. (6): a depth image of the map for each particle, by z-buffer ("vtk") or ray casting ("ray")."""
