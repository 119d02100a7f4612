"""Without embreex (no wheel for the processor) the world cannot be ray-cast, and its tests are left out."""

from importlib.util import find_spec

collect_ignore_glob = [] if find_spec("embreex") else ["test_*.py"]
