"""What data/ was made from: the simulated corridor and rooms, their furniture, and the sensors that see them.

The localization methods never import this package. What a simulated camera sees comes from the *true* world of the
run's day; a map comes from a simulated survey of the same place on another day. Nothing else passes from one
to the other.
"""
