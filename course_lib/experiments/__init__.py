"""Both papers' experiments as plain functions of a seed and parameters: tables, scores, the papers' own numbers.

Imports the methods and what is simulated; no method imports it.
"""
