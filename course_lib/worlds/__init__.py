"""The simulated corridor: its geometry, the laser survey that maps it, the depth camera that runs through it.

The localization methods never import this package. What the simulated depth camera sees is ray-cast from the *true*
world of the run day; the map comes from a simulated laser survey of the same building on another day. Nothing else
passes from one to the other.
"""
