"""The furniture that a semantic map lists, put together from solids."""
