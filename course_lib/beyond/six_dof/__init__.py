"""Beyond paper 1, section 5: all six degrees of freedom. Each module can be used alone.

poses          camera poses: small motions from one to another (`retract`, `local`), the best that differ
prediction     where the camera may be next, as wide as it has been moving
schedule       image sizes, layers of particles and steps of refinement
refinement     Gauss-Newton on the rendered depth: the equations, then the same in a compiled loop
covariance     how far off a refined pose may be, and how much of it to believe along each direction
localizer      all of it in order; the weights are depth_mcl/tempering.py, the status is beyond/being_lost.py
"""
