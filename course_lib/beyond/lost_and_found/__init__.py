"""Beyond paper 1, which is given its start: where is the camera when nobody says, and after it was carried away?

free_space      where in a map a camera can be
adaptive_count  how many particles a distribution needs (KLD-sampling)
global_search   from anywhere: many coarse particles, the best kept and followed until one pose is left
recovery        the annealed filter with an alarm: when its score falls, it searches
"""
