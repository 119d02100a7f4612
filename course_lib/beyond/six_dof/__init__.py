"""Beyond paper 1, section 5: six degrees of freedom. Each idea is a module that can be used alone.

twists         small motions along and about a camera's own axes
prediction     where the camera may be next, as wide as it has been moving
pyramid        the same view in three sizes
tempering      weights as sharp as leave enough particles
refinement     Gauss-Newton on the rendered depth; compiled_refinement: the same in a compiled loop
hypotheses     the best of many poses that differ
covariance     how far off a refined pose may be, and how much of it to believe along each direction
certainty      whether a pose is known: tracked, doubtful, lost
schedule       in which layers and by which steps a frame is searched
localizer      all of it in order
"""
