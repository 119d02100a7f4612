"""Settings of the tests of paper 2."""

from hypothesis import settings

# A machine with other work to do is slow now and then; that says nothing about the method.
settings.register_profile("no deadline", deadline=None)
settings.load_profile("no deadline")
