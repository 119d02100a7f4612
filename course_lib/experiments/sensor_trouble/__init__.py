"""Sensors that fail: frames lost, old, dark, half covered, saturated, out of order; what the methods make of them.

placing        which frames are troubled, from a seed
depth_frames   what each trouble does to a depth camera's frames
panoramas      what each does to pairs of panoramas
depth_run      paper 1's filter, and the annealed one, on troubled recordings of the corridor
stereo_run     paper 2's method on troubled walks through rooms
score          outcomes counted, recovery, confident wrong poses
"""
