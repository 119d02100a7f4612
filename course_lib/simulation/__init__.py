"""What data/ was made from: the simulated corridor and rooms, their furniture, and the sensors that see them.

The methods never import it. A map comes from a survey on another day; nothing else passes from one world to the other.
"""
