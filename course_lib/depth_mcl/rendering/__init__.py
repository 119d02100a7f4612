"""Section 3.3.1, eq. (6): a depth image of the map a particle, by z-buffer ("vtk") or by ray casting ("ray")."""
