"""Both papers' experiments as plain functions of a seed and parameters: tables, scores, the papers' own numbers.

Imports the methods and what is simulated; no method imports it. Each of the demos corridor, room, rooms, walk, lost,
trouble and finale is a module whose `run` the command `demo` calls; `runner` runs their functions for many seeds.
"""
