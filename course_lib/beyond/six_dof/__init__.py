"""Beyond paper 1, section 5: all six degrees of freedom, by an annealed filter with Gauss-Newton refinement.

localizer       a frame from the image to the estimate, and the state between frames
image_motion    how the camera moved between two images, without a map
prediction      where the camera may be at the next image
search          the search of one frame: annealed particles, refined poses, rivals
schedule        sizes of images, layers of particles, steps of refinement
refinement      Gauss-Newton on rendered depth
covariance      how far off the pose may be
calibration     whether the images fit the camera's intrinsics
poses           poses and small motions between them
"""
